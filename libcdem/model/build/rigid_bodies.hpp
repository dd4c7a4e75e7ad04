// Mass, centroid and inertia of a meshed block that keeps its shape.
//
// They are those of its lumped masses, a quarter of each tet at its corners: what its deformable self has, so that
// turning rigid and back keeps momentum and angular momentum to rounding. Mass and centroid are the solid's; the second
// moments exceed the solid's by sum_tets m/5 sum_corners s s^T, s from the tet's centroid to its corner, which falls with
// the square of the edge: about a fifth for a unit of 300 tets, deformable or rigid.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

struct RigidShape {
  RigidBody body;
  geom::Vec3 centroid = geom::Vec3::Zero(); // m
};

// With the nodes at node_position + displacement (n_nodes); null: undeformed.
RigidShape rigid_shape(const Model&, int block, const Node* displacement = nullptr);

// Model::rigid of the blocks whose body starts as Element::rigid.
void add_rigid_bodies(Model&);

// 1/kg, at a point `arm` m from the centroid: no push there moves it by more than this part of the force a unit mass
// would take, 1/m + arm^2 / I_min.
double rigid_inverse_mass(const RigidBody&, double arm);

} // namespace cdem
