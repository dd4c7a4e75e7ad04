#include "libcdem/load/flow.hpp"

#include "libcdem/state/places.hpp"

namespace cdem {
namespace {

using Pattern = std::vector<std::pair<int, geom::Vec3>>;

using NodeArea = std::vector<std::pair<int, double>>; // node, m2

// What faces give to a pattern: forces at 1 Pa of what looks towards the flow ...
struct Facing {
  const geom::Vec3& direction;
  Pattern pattern = {};

  void triangle(const geom::Triangle& nodes, const geom::Vec3& outward) {
    const double facing = -outward.dot(direction); // A alpha
    if (facing <= 0)
      return;
    for (const int node : nodes)
      pattern.emplace_back(node, facing / 3 * direction);
  }
  void block_face(const NodeArea& node_area, const geom::Vec3& normal) {
    const double alpha = -normal.dot(direction);
    if (alpha <= 0)
      return;
    for (const auto& [node, area] : node_area)
      pattern.emplace_back(node, area * alpha * direction);
  }
};

// ... or areas along the inward normal.
struct Inward {
  Pattern pattern = {};

  void triangle(const geom::Triangle& nodes, const geom::Vec3& outward) {
    for (const int node : nodes)
      pattern.emplace_back(node, outward / -3);
  }
  void block_face(const NodeArea& node_area, const geom::Vec3& normal) {
    for (const auto& [node, area] : node_area)
      pattern.emplace_back(node, -area * normal);
  }
};

// Area times the outward normal; nodes: counter-clockwise seen from outside.
geom::Vec3 outward_area(const Model& model, const State& state, const geom::Triangle& nodes) {
  const geom::Vec3 x0 = place_of(model, state, nodes[0]);
  return 0.5 * (place_of(model, state, nodes[1]) - x0).cross(place_of(model, state, nodes[2]) - x0);
}

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

bool open(const FaceStateBatch& state, int lane) {
  for (const auto& point : state.mode)
    if (is_intact(point[lane]))
      return false;
  return true;
}

template <class Add>
void each_flow_face(const Model& model, const State& state, const ResolvedFlow& flow, Add& add) {
  const auto triangle = [&](const geom::Triangle& nodes) {
    add.triangle(nodes, outward_area(model, state, nodes));
  };
  for (const int f : flow.faces) {
    const OuterFace& face = model.outer_faces[f];
    if (face.boundary >= 0)
      triangle(model.mesh.boundary[face.boundary].nodes);
    else // the part of it that no other block covered when the model was made
      add.block_face(face.node_area, present_normal(model, state, face));
  }
  if (!flow.new_faces)
    return;
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!open(state.faces[batch], lane))
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    triangle(nodes.a);
    triangle(nodes.outward_b());
  });
}

} // namespace

Pattern flow_pattern(const Model& model, const State& state, const ResolvedFlow& flow) {
  Facing facing{flow.direction};
  each_flow_face(model, state, flow, facing);
  return std::move(facing.pattern);
}

Pattern inward_areas(const Model& model, const State& state, const ResolvedFlow& flow) {
  Inward inward;
  each_flow_face(model, state, flow, inward);
  return std::move(inward.pattern);
}

} // namespace cdem
