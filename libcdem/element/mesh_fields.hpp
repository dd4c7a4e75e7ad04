// Stress, energy and stiffness of meshed bodies outside the step: for results and the stable step.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Stress of one tet of the model, with its initial stress.
Stress tet_stress(const Model&, const State&, int tet);

std::vector<Node> present_places(const Model&, const State&); // m (n_nodes)

// J, sum V sigma : C^-1 : sigma / 2 over the tets, at the present places, and of the springs on bonded faces.
double mesh_elastic_energy(const Model&, const State&);
double mesh_spring_energy(const Model&, const State&);

// One spring of a bonded face, or one point of a freed face of a cohesive body.
FaceSpring face_point_response(const Model&, const State&, const std::vector<Node>& present_places,
                               const MeshChunk&, const FaceSpringPlace&);

// As mesh stands `lag` seconds earlier, moving with its present velocity: displacement and stress.
State moved_back(const Model&, const State&, double lag);

// Adds the row sums of |K| of tets and bonded faces, N/m; per node the largest of its three rows.
void add_mesh_row_sums(const Model&, std::vector<double>& sums);

} // namespace cdem
