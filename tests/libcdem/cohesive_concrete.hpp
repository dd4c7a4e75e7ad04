// Bodies of concrete that are continuous until they crack, for the tests of cohesive bodies.
#pragma once

#include "libcdem/results/energy.hpp"
#include "libgeom/meshing/zone_mesh.hpp"
#include "tests/libcdem/boxes.hpp"

namespace testing {

constexpr double tension = 3e6, cohesion = 6e6, energy_1 = 100, energy_2 = 1000;

inline cdem::Elastic concrete() {
  cdem::Elastic m;
  m.youngs_modulus = 30e9;
  m.poissons_ratio = 0.2;
  m.density = 2400;
  return m;
}

inline cdem::Joint concrete_joint(cdem::Softening softening, double friction = 30) {
  cdem::Joint joint;
  joint.tensile_strength = tension;
  joint.cohesion = cohesion;
  joint.friction_angle = friction * degree;
  joint.softening = softening;
  if (softening != cdem::Softening::none) {
    joint.fracture_energy_1 = energy_1;
    joint.fracture_energy_2 = energy_2;
  }
  return joint;
}

inline cdem::Bonding cohesive() {
  cdem::Bonding bonding;
  bonding.kind = cdem::BondKind::cohesive;
  bonding.everywhere = true;
  bonding.stiffness_ratio = 1;
  return bonding;
}

// A box of Delaunay tetrahedra of about this edge length, its corner at the origin.
inline geom::TetMesh unstructured(const geom::Vec3& size, double edge) {
  const geom::BlockMesh zones = geom::zone_meshes({geom::make_box(geom::Vec3::Zero(), size)}, edge)[0];
  geom::TetMesh mesh;
  mesh.nodes = zones.nodes;
  mesh.tets = zones.tets;
  mesh.region.assign(mesh.tets.size(), 0);
  return mesh;
}

inline cdem::BodySpec concrete_body(geom::TetMesh mesh, cdem::Softening softening = cdem::Softening::linear,
                                    double friction = 30) {
  return meshed("concrete", std::move(mesh), cohesive(), concrete(), concrete_joint(softening, friction));
}

inline double balance(const System& s) {
  return cdem::energy(s.model, s.state).balance_error();
}

// The ends along x move apart, each at half of `speed` (m/s).
template <class Fixes>
void lead_apart(Fixes& to, double speed) {
  for (const double way : {-1.0, 1.0}) {
    cdem::Fix lead = fixed(cdem::Selection::side(way < 0 ? "x-" : "x+"), "x");
    lead.velocity = geom::Vec3(0.5 * way * speed, 0, 0);
    to.push_back(lead);
  }
}

// Mean traction on the side x+ of a box, Pa.
inline double end_traction(const System& s, double section) {
  const std::vector<geom::Vec3> forces = s.net_forces();
  double sum = 0;
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (std::abs(s.model.node_position[i].x() - s.model.box.max.x()) < 1e-9)
      sum -= forces[i].x();
  return sum / section;
}

} // namespace testing
