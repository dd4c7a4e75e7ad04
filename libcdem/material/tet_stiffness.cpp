#include "libcdem/material/tet_stiffness.hpp"

namespace cdem {

TetGradients tet_gradients(const std::array<geom::Vec3, 4>& x) {
  TetGradients g;
  const geom::Vec3 e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0];
  const double six_volume = e1.dot(e2.cross(e3));
  g.volume = six_volume / 6;
  g.gradient[1] = e2.cross(e3) / six_volume;
  g.gradient[2] = e3.cross(e1) / six_volume;
  g.gradient[3] = e1.cross(e2) / six_volume;
  g.gradient[0] = -(g.gradient[1] + g.gradient[2] + g.gradient[3]);
  return g;
}

geom::Mat3 stiffness_block(const Elastic& material, double volume, const geom::Vec3& p, const geom::Vec3& q) {
  return stiffness_block(material.lame_lambda(), material.shear_modulus(), volume, p, q);
}

} // namespace cdem
