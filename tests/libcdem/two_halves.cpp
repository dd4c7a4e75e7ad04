#include "tests/libcdem/two_halves.hpp"

#include "libgeom/mesh/box_mesh.hpp"

namespace testing {

using geom::Vec3;

geom::TetMesh two_halves(int n) {
  geom::TetMesh mesh = geom::box_mesh({side, side, 2 * half}, {n, n, 2 * n});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0;
    for (const int node : mesh.tets[t])
      z += mesh.nodes[node].z() / 4;
    mesh.region[t] = z > half;
  }
  return mesh;
}

cdem::Bonding between_halves(double ratio) {
  cdem::Bonding bonding;
  bonding.between_regions = true;
  bonding.stiffness_ratio = beta;
  bonding.shear_ratio = ratio;
  return bonding;
}

cdem::Joint halves_joint(bool bonded) {
  cdem::Joint j;
  j.bonded = bonded;
  j.cohesion = 2e6;
  j.friction_angle = 35 * degree;
  j.tensile_strength = 1.5e6;
  return j;
}

std::vector<char> upper_nodes(const cdem::Model& model) {
  std::vector<char> upper(model.node_position.size(), 0);
  for (const geom::Tet& tet : model.tets) {
    double z = 0;
    for (const int node : tet)
      z += model.node_position[node].z() / 4;
    for (const int node : tet)
      upper[node] = z > half;
  }
  return upper;
}

Halves::Halves(const cdem::Joint& j, geom::Mat3 turn, double ratio)
    : system(build({meshed("unit", two_halves(1), between_halves(ratio), rock(), j)})),
      turn_(std::move(turn)), upper_(upper_nodes(system.model)), ratio_(ratio) {
  // d = 3 (V1 + V2) / 4A with V = h^2 half / 6 and A = h^2 / 2.
  kn_ = beta * rock().youngs_modulus / (half / 2);
}

Vec3 Halves::go(const Vec3& traction) {
  const double ks = ratio_ * kn_;
  return lead({traction.x() / ks, traction.y() / ks, traction.z() / kn_});
}

Vec3 Halves::lead(const Vec3& gap) {
  for (std::size_t i = 0; i < upper_.size(); ++i) {
    const Vec3& x = system.model.node_position[i];
    system.state.displacement[i] = node(turn_ * x - x + (upper_[i] ? Vec3(turn_ * gap) : Vec3::Zero()));
  }
  const std::vector<Vec3> forces = system.advance_springs(breaks_);
  Vec3 force = Vec3::Zero();
  for (std::size_t i = 0; i < upper_.size(); ++i)
    if (upper_[i])
      force += forces[i];
  return turn_.transpose() * force / area;
}

int Halves::with_mode(cdem::BondMode mode) const {
  int count = 0;
  each_face_spring(system.model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace& at) {
    count += system.state.faces[at.batch].mode[at.point][at.lane] == static_cast<std::uint8_t>(mode);
  });
  return count;
}

int Halves::handed_over() const {
  int count = 0;
  each_face_spring(system.model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace& at) {
    count += at.point == 0 && (cdem::handed_over(system.state.faces[at.batch], at.lane) ||
                               cdem::leaves(system.state.faces[at.batch], at.lane));
  });
  return count;
}

} // namespace testing
