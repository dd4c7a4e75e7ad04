#include "libcdem/load/opened_faces.hpp"

#include "libcdem/model/face_fan.hpp"

#include <map>
#include <set>

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

} // namespace

std::vector<OuterFace> opened_faces(const Model& model, const State& state) {
  constexpr double nothing = 1e-9; // of a face
  const auto covers = [&](int point) {
    return is_intact(state.bond_mode[point]) ||
           (!state.water_pressure.empty() && state.water_pressure[point] > 0);
  };
  std::set<Place> open;
  for (const Interface& interface : model.interfaces) {
    bool whole = interface.point_end > interface.point_begin;
    for (int p = interface.point_begin; whole && p < interface.point_end; ++p)
      whole = covers(p);
    if (!whole) {
      open.insert({interface.block_a, interface.face_a});
      open.insert({interface.block_b, interface.face_b});
    }
  }
  if (open.empty())
    return {};
  std::map<Place, NodeAreas> covered;
  const auto cover = [&](const Place& place, int node, double area) {
    if (open.count(place) != 0)
      covered[place][node] += area;
  };
  for (const OuterFace& face : model.outer_faces)
    for (const auto& [node, area] : face.node_area)
      cover({face.block, face.face}, node, area);
  for (const Interface& interface : model.interfaces)
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      if (covers(p))
        for (int k = 0; k < 3; ++k) {
          const BondPoint& point = model.points[p];
          cover({interface.block_a, interface.face_a}, point.node_a[k], point.area * point.weight_a[k]);
          cover({interface.block_b, interface.face_b}, point.node_b[k], point.area * point.weight_b[k]);
        }
  std::vector<OuterFace> faces;
  for (const Place& place : open) {
    NodeAreas bare = whole_face(model, place);
    double whole = 0;
    for (const auto& [node, area] : bare)
      whole += area;
    for (const auto& [node, area] : covered[place])
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
    faces.push_back(std::move(face));
  }
  return faces;
}

} // namespace cdem
