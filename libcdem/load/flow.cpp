#include "libcdem/load/flow.hpp"

#include "libcdem/load/inner_shells.hpp"

#include "libcdem/load/gone_body.hpp"
#include "libcdem/load/opened_faces.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem {
namespace {

using Pattern = std::vector<std::pair<int, geom::Vec3>>;

// What faces give to a pattern: forces at 1 Pa of what looks towards the flow ...
struct Facing {
  const geom::Vec3& direction;
  Pattern pattern = {};

  void corner(int node, double area, const geom::Vec3& outward) {
    const double facing = -area * outward.dot(direction); // A alpha
    if (facing > 0)
      pattern.emplace_back(node, facing * direction);
  }
};

// ... or areas along the inward normal.
struct Inward {
  std::vector<FlowCorner> corners = {};

  void corner(int node, double area, const geom::Vec3& outward) {
    corners.push_back({node, -area * outward, geom::Vec3::Zero()});
  }
};

template <class Add>
void each_flow_face(const Model& model, const State& state, const ResolvedFlow& flow, Add& add) {
  const auto corners = [&](const geom::Triangle& nodes) {
    return std::array<geom::Vec3, 3>{place_of(model, state, nodes[0]), place_of(model, state, nodes[1]),
                                     place_of(model, state, nodes[2])};
  };
  const auto block_face = [&](const OuterFace& face) {
    const geom::Vec3 normal = present_normal(model, state, face);
    for (const auto& [node, area] : face.node_area)
      add.corner(node, area, normal);
  };
  for (std::size_t i = 0; i < flow.faces.size(); ++i) {
    const OuterFace& face = model.outer_faces[flow.faces[i]];
    if (face.boundary >= 0) {
      const geom::Triangle& nodes = model.mesh.boundary[face.boundary].nodes;
      const std::array<geom::Vec3, 3> x = corners(nodes);
      const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
      const CornerNormals normals = turned_with(flow.normals[i], x);
      for (int k = 0; k < 3; ++k)
        add.corner(nodes[k], area / 3, normals[k]);
    } else { // the part of it that no other block covered when the model was made
      block_face(face);
    }
  }
  if (!flow.new_faces)
    return;
  for (const CrackSide& side : crack_sides(model, state, flow.meets)) {
    if (!side.parted)
      continue;
    const std::array<geom::Vec3, 3> x = corners(side.nodes);
    const geom::Vec3 outward = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
    for (const int node : side.nodes)
      add.corner(node, 1, outward / 3);
  }
  for (const BaredFace& bared : opened_faces(model, state, flow.meets))
    if (bared.parted)
      block_face(bared.face);
}

} // namespace

// Outward, unit, of a face of a convex block where it stands now; a block of small strain hardly turns.
geom::Vec3 present_normal(const Model& model, const State& state, const OuterFace& face) {
  const Block& block = model.blocks[face.block];
  if (!block.meshed)
    return face.normal;
  const std::vector<int>& loop = block.shape.faces[face.face].loop;
  const auto vertex = [&](std::size_t i) { return place_of(model, state, block.node_begin + loop[i]); };
  const geom::Vec3 x0 = vertex(0);
  geom::Vec3 twice_area = geom::Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    twice_area += (vertex(i) - x0).cross(vertex(i + 1) - x0);
  return twice_area.normalized();
}

Pattern flow_pattern(const Model& model, const State& state, const ResolvedFlow& flow) {
  Facing facing{flow.direction};
  each_flow_face(model, state, flow, facing);
  return std::move(facing.pattern);
}

std::vector<FlowCorner> flow_corners(const Model& model, const State& state, const ResolvedFlow& flow) {
  Inward inward;
  each_flow_face(model, state, flow, inward);
  return std::move(inward.corners);
}

std::vector<int> flow_faces(const Model& model, const Flow& flow, const std::vector<int>& shells) {
  std::vector<int> faces;
  for (const Selection& on : flow.on) {
    const std::vector<int> here = selected_outer_faces(model, on);
    faces.insert(faces.end(), here.begin(), here.end());
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  faces.erase(std::remove_if(faces.begin(), faces.end(),
                             [&](int f) {
                               const int boundary = model.outer_faces[f].boundary;
                               return boundary >= 0 && shells[boundary] != 0;
                             }),
              faces.end());
  return faces;
}

std::vector<int> flow_faces(const Model& model, const Flow& flow) {
  return flow_faces(model, flow, of_inner_shells(model));
}

} // namespace cdem
