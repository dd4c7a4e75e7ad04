// Volume strain and mean stress of tets averaged over nodes and back, so that a mesh of constant-strain tets does not
// lock in plastic flow. If each tet keeps its volume by itself, its nodes have too little freedom.
//
//   q_a = sum V_e q_e / sum V_e over the tets e at node a,     (A q)_e = (q_1 + q_2 + q_3 + q_4) / 4 of the nodes of e
//
// (average nodal pressure: Bonet and Burton 1998, Commun. Numer. Meth. Engng 14; nodal mixed discretization: Detournay and
// Dzik 2006). The strain of a tet has B theta in place of its own volume strain theta, and its forces are those of a stress
// with B p in place of its own mean stress p, B = (1 - s) A + s. With s = 0 only its shear stiffness would keep a tet
// from turning inside out, and in plastic flow not even that. So s = 0.1. Weighted with V the operator is its own
// adjoint,
//
//   sum V p (B theta) = sum V (B p) theta
//
// so that forces and strains do the same work. Its eigenvalues lie in [0, 1]: no vibration gets faster. Averages are those
// of the tets of one chunk: blocks are whole in theirs; along the borders of the chunks of a mesh fewer tets share in them.
#pragma once

#include "libcdem/element/finite_volume.hpp"

namespace cdem {

// A chunk's tets and nodes, as in finite_volume_forces.
struct AveragedTets {
  const MeshBatch* batches = nullptr;
  std::int64_t count = 0;
  int last_lanes = lanes; // of the last batch
  std::int64_t places = 0;
  const Node* position = nullptr; // m (places)
};

// Adds what the average changes of the strain of the step: jumps, one for each batch (2V times the strain).
void add_volume_averages(const AveragedTets&, const Node* velocity, double dt, JumpBatch* jumps);

// Adds the forces of what the average changes of the stress.
void add_pressure_averages(const AveragedTets&, const StressBatch* stress, Node* force);

} // namespace cdem
