// How two tetrahedra that press each other act as one contact: a pure function, several pairs side by side.
//
// The forces f_i stand at the eight corners (tet_potential.hpp); those on the first tetrahedron sum up to F. The normal force is
// N = F . n along a direction n that is given. It presses at the mean of the corners of both, weighted by |f_i . n|; the shear force
// acts there, at one place of both tetrahedra, so that the two keep momentum and angular momentum.
#pragma once

#include "libcdem/contact/response/tet_potential.hpp"

namespace cdem {

struct TetPairPush {
  double normal[3][lanes]; // n, given: unit, on the first
  double force[lanes];     // N; 0 where F does not point along n: then what follows has no meaning
  double closing[lanes];   // m, in the step: - step sum f_i . v_i / N
  double slid
      [3]
      [lanes]; // m, in the step: of the first past the second, across n as the place moves, along n by -closing
  double turned[lanes]; // rad, in the step: mean turn of the two about n
  double
      weight[8]
            [lanes]; // of the shear force at the corners: of the first they sum up to 1, of the second to -1
  double compliance[lanes]; // 1/kg, sum |f_i|^2 / (N^2 m_i)
  double length[8][lanes];  // N, |f_i|
};

// place, velocity: of nodes, m and m/s; mass: kg, of nodes, null where no compliance is asked for. step: s.
void find_pushes(const Node* place, const Node* velocity, const double* mass, double step,
                 const TetPairPress*, TetPairPush*, std::int64_t count);

} // namespace cdem
