// Mass, centroid and inertia of a meshed block that keeps its shape.
//
// They are those of the solid its tets fill: for a tet of mass m with corners r_i about the centroid the second moments are
//   integral r r^T dm = m / 20 (sum r_i r_i^T + (sum r_i)(sum r_i)^T).
// A deformable body has its masses at its nodes, a quarter of each tet at its corners. Mass and centroid are the same, the
// second moments larger by sum_tets m/5 sum_corners s s^T, s from the tet's centroid to its corner: three quarters more for a
// cube of one block, a fifth for a unit of 300 tets, falling with the square of the edge.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

struct RigidShape {
  RigidBody body;
  geom::Vec3 centroid = geom::Vec3::Zero();          // m
  geom::Mat3 nodal_inertia = geom::Mat3::Identity(); // kg m2, of the masses at its nodes, about the centroid
};

// With the nodes at node_position + displacement (n_nodes); null: undeformed.
RigidShape rigid_shape(const Model&, int block, const Node* displacement = nullptr);

// Model::rigid of the blocks whose body starts as Element::rigid.
void add_rigid_bodies(Model&);

// 1/kg, at a point `arm` m from the centroid: no push there moves it by more than this part of the force a unit mass
// would take, 1/m + arm^2 / I_min.
double rigid_inverse_mass(const RigidBody&, double arm);

} // namespace cdem
