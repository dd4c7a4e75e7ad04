// Pressure of two tetrahedra on each other.
//
// In a tetrahedron stands the field
//
//   phi(x) = min over its open planes k of  D_k(x),     D_k = depth of x below plane k - offset
//
// A plane is open where nothing holds on to it: at the outside, and at a face without a whole bond. The others, behind which
// its piece goes on, only end the field: what passes them goes over to the next tetrahedron, at the same depth where
// the surface is flat. Where one of the two has such planes, an open plane counts for what lies beyond it with its centroid and
// has an open face opposite: a tetrahedron that has but an edge in the surface that is touched would press out of another one
// of its faces, and the front of a body that slides would stumble over every node.
// The corners and edges of the open faces of the other one that lie in it store the energy
//
//   U = sum over corners  kappa/2 <phi>^2  +  sum over edges  kappa/2 integral over 0..1 of <phi>^2 dt
//
// and both do so in each other. kappa is a twelfth of the stiffness of a full contact of the two: a face that lies on a
// larger one has three corners and three edges, and the larger one has as much.
// Forces are the exact gradient of U with respect to all eight corners, so that energy, momentum and angular momentum are
// kept. The normal n has the direction of the resultant on a. Each corner takes the part f_i . n / N of the normal
// force N, and the same part of the shear force T of one spring:
//
//   T' = T - ks (slip past b in the step),  |T'| <= N tan(phi)
//
// T turns with n. Energies of friction follow the trapezoidal rule.
#pragma once

#include "libcdem/parallel/node.hpp"

#include <array>
#include <cstdint>

namespace cdem {

// Pairs of tetrahedra out of a list of pairs. Corner k of tetrahedron t stands at place[4 t + k].
struct PairsOfTets {
  const Node* place;         // m
  const std::int32_t *a, *b; // tetrahedra of each pair of the list
  const std::uint8_t* open;  // planes of each tetrahedron, a bit each, by the corner opposite
  const std::int32_t* row;   // which pairs of the list
  std::int64_t count;        // of them
};

// m, per pair: by how much the best of the eight planes parts the two; negative where none does.
void parted_by_planes(const PairsOfTets&, double* gap);

// m, per pair: the largest phi of any corner or edge with this offset; negative: so far they are from touching.
void deepest_in_each_other(const PairsOfTets&, const double* offset, double* phi);

// Damping: F_d = c v at the speed v of approach, at most r N both ways, with the corners' parts of N. It takes energy in every
// step.
struct TetLaw {
  double kappa = 0, ks = 0; // N/m
  double tan_friction = 0;
  double step = 0; // s
  double damping = 0, damping_ratio = 0; // c, N s/m, and r
  double rim = 0;  // m, by which a field goes on beyond planes that are not open: there the next one begins
};

struct TetPressure {
  std::array<std::array<double, 3>, 8> force; // N, at the corners of a and b
  std::array<double, 8> part;                 // of the forces, of each corner: their sum is 1 for a and for b
  std::array<double, 3> shear;                // N, on a
  std::array<double, 3> normal;               // unit
  double pressing;                            // N; 0: it does not press
  double stored;                              // J, of phi
  double stiffness;                           // N/m, of the normal force over the offset
  double depth;                               // m, the largest phi
  double friction, damping;                   // J, in the step
  double work;                                // J, that the normal forces of now do over the motion of the step
  double tolerance;                           // J, by which that may differ from what phi gives, where nothing jumps
};

// shear: N, before the step, three a pair. velocity: m/s, of corners as places; null: nothing slides, friction takes nothing.
// Written where a pair's pointer stands.
void press(const PairsOfTets&, const Node* velocity, const double* offset, const TetLaw*, const double* shear,
           TetPressure* const*);

} // namespace cdem
