// Stiffness of a linear tetrahedron: K_kl = V (lambda g_k (x) g_l + G g_l (x) g_k + G g_k . g_l I), with the gradients g of
// its shape functions (Han 2010 eqs 1-7).
#pragma once

#include "libcdem/material/elastic.hpp"
#include "libgeom/core/types.hpp"

#include <array>

namespace cdem {

struct TetGradients {
  double volume = 0;      // m3
  geom::Vec3 gradient[4]; // 1/m, of the shape functions
};
TetGradients tet_gradients(const std::array<geom::Vec3, 4>& corners); // m

// N/m, between two nodes; volume: m3; p, q: the gradients at the two, 1/m.
geom::Mat3 stiffness_block(const Elastic&, double volume, const geom::Vec3& p, const geom::Vec3& q);
inline geom::Mat3 stiffness_block(double lambda, double shear, double volume, const geom::Vec3& p,
                                  const geom::Vec3& q) {
  return volume * (lambda * p * q.transpose() + shear * (q * p.transpose()) +
                   shear * p.dot(q) * geom::Mat3::Identity());
}

} // namespace cdem
