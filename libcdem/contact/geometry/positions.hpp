// Where corners of the contact surface are.
#pragma once

#include "libcdem/state/places.hpp"

#include <algorithm>

namespace cdem {

// Semi-springs stand in from their corners by this fraction of the distance to each of the two others, and semi-edges
// do not meet first in this part of them at an end: more than rock and concrete are pressed together before they break,
// so that blocks set in rows do not meet those across their edges and corners, and the corners of cracks keep clear of
// each other.
inline constexpr double drawn_in = 0.005;

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

// The angular velocity about `normal` of a line that moves with its ends, rad/s.
inline double spin(const geom::Vec3& along, const geom::Vec3& relative_velocity, const geom::Vec3& normal) {
  return normal.cross(along).dot(relative_velocity) / along.squaredNorm();
}

// The same of a triangle, by all its edges: whichever is numbered first. velocity: m/s, of the corners.
inline double spin(const Corners& x, const Corners& velocity, const geom::Vec3& normal) {
  double turns = 0, square = 0;
  for (int i = 0; i < 3; ++i) {
    const geom::Vec3 along = x[(i + 1) % 3] - x[i], across = normal.cross(along);
    turns += across.dot(velocity[(i + 1) % 3] - velocity[i]);
    square += across.squaredNorm();
  }
  return square > 0 ? turns / square : 0;
}

inline bool has_bonds(const Model& model, int block) {
  const Bonding& bonding = model.bodies[model.blocks[block].body].bonding;
  return bonding.everywhere || bonding.between_regions || !bonding.regions.empty();
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
