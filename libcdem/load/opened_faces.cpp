#include "libcdem/load/opened_faces.hpp"

#include "libcdem/bond/face_frame.hpp"
#include "libcdem/bond/fragments.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/model/face_fan.hpp"

#include <cmath>
#include <map>

namespace cdem {
namespace {

using Place = std::pair<int, int>; // block, face
using NodeAreas = std::map<int, double>;

// Integrals of the shape functions of a face's nodes over it, m2.
NodeAreas whole_face(const Model& model, const Place& place) {
  NodeAreas areas;
  const int first = model.blocks[place.first].node_begin;
  for (const geom::Triangle& t : fan_of(model, place.first, place.second)) {
    const auto x = [&](int corner) { return model.node_position[first + t[corner]]; };
    const double area = 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
    for (const int node : t)
      areas[first + node] += area / 3;
  }
  return areas;
}

constexpr double parted_by = 0.01; // of the block's size

bool has_parted(const Model& model, const State& state, const Interface& interface) {
  if (released(state, interface) || interface.point_end == interface.point_begin)
    return true;
  double area = 0, open = 0;
  for (int p = interface.point_begin; p < interface.point_end; ++p) {
    const BondPoint& point = model.points[p];
    area += point.area;
    open += point.area * local_jump(model, state.displacement, p).dot(point.normal);
  }
  return open > parted_by * area *
                    std::min(model.blocks[interface.block_a].size, model.blocks[interface.block_b].size);
}

// size: m, of the face; block_size: m.
bool has_parted(const FaceFrame& f, double size, double block_size) {
  const geom::Vec3 mean = f.in_axes((f.gap[0] + f.gap[1] + f.gap[2]) / 3);
  return f.torn || mean[2] > parted_by * block_size || mean.head<2>().norm() > size;
}

// What is known of a face that some open interface lies on.
struct Opening {
  bool parted = true; // all these interfaces have
  NodeAreas covered;  // m2
};

} // namespace

std::vector<BaredFace> opened_faces(const Model& model, const State& state, const std::vector<Met>& met) {
  constexpr double nothing = 1e-9; // of a face
  const auto covers = [&](int point) {
    return is_intact(state.bond_mode[point]) ||
           (!state.water_pressure.empty() && state.water_pressure[point] > 0);
  };
  const auto reaches = [&](int block, int beyond) {
    return met[block] == Met::whole || (met[block] == Met::places && met[beyond] != Met::nothing);
  };
  std::map<Place, Opening> open;
  for (const Interface& interface : model.interfaces) {
    bool whole = interface.point_end > interface.point_begin;
    for (int p = interface.point_begin; whole && p < interface.point_end; ++p)
      whole = covers(p);
    if (whole)
      continue;
    const bool parted = has_parted(model, state, interface);
    const auto add = [&](int block, int face, int beyond) {
      if (!reaches(block, beyond))
        return;
      Opening& opening = open[{block, face}];
      opening.parted = opening.parted && parted;
    };
    add(interface.block_a, interface.face_a, interface.block_b);
    add(interface.block_b, interface.face_b, interface.block_a);
  }
  if (open.empty())
    return {};
  const auto cover = [&](const Place& place, int node, double area) {
    if (const auto found = open.find(place); found != open.end())
      found->second.covered[node] += area;
  };
  for (const OuterFace& face : model.outer_faces)
    for (const auto& [node, area] : face.node_area)
      cover({face.block, face.face}, node, area);
  for (const Interface& interface : model.interfaces) {
    const int a = interface.block_a, b = interface.block_b;
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      for (int k = 0; k < 3; ++k) {
        const BondPoint& point = model.points[p];
        if (covers(p) || !reaches(a, b))
          cover({a, interface.face_a}, point.node_a[k], point.area * point.weight_a[k]);
        if (covers(p) || !reaches(b, a))
          cover({b, interface.face_b}, point.node_b[k], point.area * point.weight_b[k]);
      }
  }
  std::vector<BaredFace> faces;
  for (const auto& [place, opening] : open) {
    NodeAreas bare = whole_face(model, place);
    double whole = 0;
    for (const auto& [node, area] : bare)
      whole += area;
    for (const auto& [node, area] : opening.covered)
      bare[node] -= area;
    OuterFace face;
    face.block = place.first;
    face.face = place.second;
    face.normal = geom::face_normal(model.blocks[place.first].shape, place.second);
    for (const auto& [node, area] : bare)
      face.area += area;
    if (!(face.area > nothing * whole))
      continue;
    face.node_area.assign(bare.begin(), bare.end());
    faces.push_back({std::move(face), opening.parted});
  }
  return faces;
}

std::vector<CrackSide> crack_sides(const Model& model, const State& state, const std::vector<Met>& met) {
  std::vector<CrackSide> sides;
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (met[chunk.block] == Met::nothing || is_bonded(state, batch, lane))
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    const FaceFrame frame = face_frame(
        nodes, [&](int node) { return place_of(model, state, node); },
        [&](int node) { return vec(state.displacement[node]); });
    const bool parted =
        has_parted(frame, std::sqrt(3 * model.mesh.faces[batch].area[lane]), model.blocks[chunk.block].size);
    sides.push_back({chunk.block, nodes.a, parted});
    sides.push_back({chunk.block, nodes.outward_b(), parted});
  });
  return sides;
}

} // namespace cdem
