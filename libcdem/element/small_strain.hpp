// Linear tets at small strain (Han 2010 eqs 1-7), matrix free: with the gradients g_k of the shape functions
//   grad u = sum_k (u_k - u_0) (x) g_k,   sigma = lambda tr(eps) I + 2 G eps,   f_k = -V sigma g_k,  f_0 = -sum f_k.
#pragma once

#include "libcdem/material/tet_stiffness.hpp"
#include "libcdem/parallel/read_ahead.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Adds the nodal forces of `count` batches; displacement, force: of the chunk's nodes, first node first.
void add_small_strain_forces(const TetBatch* batches, std::int64_t count, const Node* displacement,
                             Node* force, ReadAhead ahead = {});

// Nodal forces of a stress in a tet.
void add_stress_forces(const Model&, int tet, const Stress&, std::vector<Node>& force);

geom::Mat3 displacement_gradient(const Model&, const std::vector<Node>& displacement, int tet); // du_i / dx_j
// 1/s, of the velocity in space, where the nodes are now.
geom::Mat3 velocity_gradient(const Model&, const State&, int tet);
Stress elastic_stress(const Elastic&, const geom::Mat3& gradient); // without initial stress
double tet_volume(const Model&, int tet);                          // m3, undeformed

// Volume means over a block.
geom::Mat3 block_gradient(const Model&, const std::vector<Node>& displacement, const Block&);
Stress block_stress(const Model&, const State&, int block); // initial stress included
// The rotation of the mean deformation I + grad u (polar decomposition); the identity for a block of small strain.
geom::Mat3 block_rotation(const Model&, const State&, int block);
// The rotation in a deformation gradient or any other matrix with a positive determinant.
geom::Mat3 rotation_in(const geom::Mat3&);

geom::Mat3 matrix(const Stress&);
Stress tensor(const geom::Mat3&); // symmetric part
// Turns a stress of a rigid body from the directions in which the body was made rigid to its present directions.
Stress turned(const geom::Mat3& rotation, const Stress&);

// Row sums of |K| of the star blocks' own stiffness, N/m: per node the largest of its three rows. A Gershgorin bound.
std::vector<double> stiffness_row_sums(const Model&);

} // namespace cdem
