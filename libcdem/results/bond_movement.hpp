// Where the points of bonds have moved: the mean of their two sides, m.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/state/places.hpp"

namespace cdem {

// Of a spring of an interface. u(node): displacement.
template <class Displacement>
geom::Vec3 point_movement(const BondPoint& point, const Displacement& u) {
  geom::Vec3 moved = geom::Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    moved +=
        0.5 * (point.weight_a[k] * vec(u(point.node_a[k])) + point.weight_b[k] * vec(u(point.node_b[k])));
  return moved;
}

// Of one of the three springs of a face of a mesh.
template <class Displacement>
geom::Vec3 point_movement(const FaceNodes& nodes, int point, const Displacement& u) {
  geom::Vec3 moved = geom::Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    moved += 0.5 * (k == point ? 2.0 / 3 : 1.0 / 6) * (vec(u(nodes.a[k])) + vec(u(nodes.b[k])));
  return moved;
}

} // namespace cdem
