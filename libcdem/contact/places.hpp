// Where corners and edges of the contact surface are.
#pragma once

#include "libcdem/state/places.hpp"

namespace cdem {

using Corners = std::array<geom::Vec3, 3>;

inline Corners corners_of(const Model& model, const State& state, const geom::Triangle& nodes) {
  return {place_of(model, state, nodes[0]), place_of(model, state, nodes[1]),
          place_of(model, state, nodes[2])};
}
inline geom::Vec3 unit_normal(const Corners& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).normalized();
}
inline geom::Vec3 weighted(const Corners& x, const geom::Vec3& w) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
}

// From an edge with its ends at x0 and x1 into its two faces, at right angles to it (m, a third of their height there).
inline std::array<geom::Vec3, 2> into_faces(const Model& model, const State& state, const ContactEdge& e,
                                            const geom::Vec3& x0, const geom::Vec3& x1) {
  const geom::Vec3 along = (x1 - x0).normalized();
  std::array<geom::Vec3, 2> into;
  for (int i = 0; i < 2; ++i) {
    const Corners x = corners_of(model, state, model.surface.triangles[e.triangles[i]].nodes);
    into[i] = (x[0] + x[1] + x[2]) / 3 - x0;
    into[i] -= into[i].dot(along) * along;
  }
  return into;
}
// The fan of an edge's outward normals: those that have both its faces behind.
inline bool in_fan(const std::array<geom::Vec3, 2>& into, const geom::Vec3& normal) {
  return !(normal.dot(into[0]) > 0) && !(normal.dot(into[1]) > 0);
}

inline bool apart(const geom::Box& a, const geom::Box& b) {
  return (a.min.array() > b.max.array()).any() || (b.min.array() > a.max.array()).any();
}
inline geom::Box grown(geom::Box box, double by) {
  box.min.array() -= by;
  box.max.array() += by;
  return box;
}
inline geom::Box box_of(const Corners& x, double around) {
  geom::Box box;
  for (const geom::Vec3& corner : x)
    box.extend(corner);
  return grown(box, around);
}

} // namespace cdem
