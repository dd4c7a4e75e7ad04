// Stress, energy and stiffness of meshed bodies outside the step: for results and the stable step.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Stress of one tet of the model, with its initial stress.
Stress tet_stress(const Model&, const State&, int tet);

std::vector<Node> present_places(const Model&, const State&); // m (n_nodes)

// J, sum V sigma : C^-1 : sigma / 2 over the tets, as they stood `lag` seconds ago, moving with their present velocity.
double mesh_elastic_energy(const Model&, const State&, double lag = 0);
double mesh_spring_energy(const Model&, const State&); // J, of the springs on bonded faces

// One spring of a bonded face, or one point of a freed face of a cohesive body.
FaceSpring face_point_response(const Model&, const State&, const std::vector<Node>& present_places,
                               const MeshChunk&, const FaceSpringPlace&);

// m (n_nodes), `lag` seconds ago, with the present velocity; and the State with that displacement, all else as it is now.
std::vector<Node> displacement_ago(const State&, double lag);
State moved_back(const State&, double lag);

// Adds the row sums of |K| of tets and bonded faces, N/m; per node the largest of its three rows. rows: of those nodes that are 1
// alone (n_nodes); empty: of all.
void add_mesh_row_sums(const Model&, std::vector<double>& sums, const std::vector<char>& rows = {});

} // namespace cdem
