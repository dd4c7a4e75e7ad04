// Pressure p of a gas or a fluid on the faces of cracks in cohesive bodies. A face takes it as it opens. Its area is A, its
// normal n points from side a to side b, and A n is the mean of both sides where they stand. The damaged part D is wet:
//
//   force on side a = -p D A n,   force on side b = p D A n
//
// D is the mean damage of the face's three points (joint/softening.hpp), 1 for a brittle face that has let go. p is given
// over time, or a fluid with the bulk modulus K fills the cracks and a reservoir of the volume V_0, into which V(t) has been
// pumped:
//
//   p = max(0, K (V(t) - V_c) / V_0),   V_c = sum over the wet faces of D A n . (mean opening)
//
// Its work is counted as that of other loads: the forces of a step times the mean of the velocities before and after it.
//
// The pressure is the same everywhere: the fluid has no viscosity. V_c is taken at the beginning of the step, so the fluid
// is a spring that couples all wet faces. Its frequency w bounds the time step; by Gershgorin, with the masses of nodes at
// least those of single tets (density rho, volume V), of which at most three faces are wet:
//
//   w^2 <= 8 (K / V_0) (sum of D A) max(A / rho V)
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct CrackLoad {
  CrackPressure given;
  std::vector<char> faces; // batch * lanes + lane: 1 takes it
  double pressure = 0;     // Pa, now
  double frequency2 = 0;   // 1/s2, w^2 above; 0: the pressure is given
};

// Throws geom::InputError where no face that may crack has its centroid in `on`.
void require_cracks(const Model&, const Selection& on);

CrackLoad resolve(const Model&, const State&, const CrackPressure&);

// Pressures at `time`. own: chunks of the mesh in which this rank measures cracks.
void update_crack_pressures(const Model&, const State&, Range own, double time, std::vector<CrackLoad>&);

// Adds the forces on the nodes of a chunk (N, per place), and to the sums what they are and their squares.
void add_crack_pressures(const Model&, const State&, const MeshChunk&, const std::vector<CrackLoad>&,
                         const FaceMotion&, Node* force, FaceSums&);

// Their work in a step, J, once the nodes have moved. kick: s, from the time of the velocities before it to that of those
// after it; 1 in a relaxation.
double crack_work(const State&, const std::vector<CrackPush>&, double kick);

// Volume of all cracks that take the load, m3.
double crack_volume(const Model&, const State&, const CrackLoad&);

// Longest stable step, s, that pumped fluids leave to a mesh whose own is `stable`; without them no limit.
double crack_time_step(const std::vector<CrackLoad>&, double stable);

} // namespace cdem
