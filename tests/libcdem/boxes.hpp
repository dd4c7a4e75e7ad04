// Boxes that touch, and what is measured of them.
#pragma once

#include "libcdem/contact/response/contact_point.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

namespace testing {

inline geom::TetMesh placed(geom::TetMesh mesh, const geom::Mat3& turn, const geom::Vec3& shift) {
  for (geom::Vec3& x : mesh.nodes)
    x = turn * x + shift;
  return mesh;
}

// A box about the origin, then turned and moved.
inline geom::TetMesh box_at(const geom::Vec3& size, const std::array<int, 3>& divisions,
                            const geom::Mat3& turn, const geom::Vec3& shift) {
  return placed(placed(geom::box_mesh(size, divisions), geom::Mat3::Identity(), -0.5 * size), turn, shift);
}

inline cdem::Elastic soft_rock(double youngs_modulus = 1e8) {
  cdem::Elastic material = rock();
  material.youngs_modulus = youngs_modulus;
  return material;
}

// m, the lowest node of a block.
inline double lowest(const System& s, int block) {
  double z = 1e300;
  for (int n = s.model.blocks[block].node_begin; n < s.model.blocks[block].node_end; ++n)
    z = std::min(z, s.model.node_position[n].z() + s.state.displacement[n].z);
  return z;
}

inline cdem::Joint friction(double angle) {
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = angle * degree;
  return joint;
}

inline cdem::Selection body_of(const char* name) {
  return cdem::Selection::of_body(name);
}

inline geom::Vec3 centroid(const System& s, int block) {
  geom::Vec3 sum = geom::Vec3::Zero();
  double mass = 0;
  for (int n = s.model.blocks[block].node_begin; n < s.model.blocks[block].node_end; ++n) {
    sum += s.model.node_mass[n] * (s.model.node_position[n] + vec(s.state.displacement[n]));
    mass += s.model.node_mass[n];
  }
  return sum / mass;
}

inline double normal_force(const System& s, const cdem::Contact& c) { // N
  return cdem::law_of(s.model, c).kn * c.effective_penetration();
}

} // namespace testing
