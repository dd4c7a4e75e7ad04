// Forces that hold the two sides of a freed face of a cohesive body together until it reaches its strength: the
// symmetric interior penalty form of the discontinuous Galerkin method (Noels and Radovitzky 2008, Int. J. Numer. Meth.
// Engng 74), on constant-stress tets. With j the relative displacement from side 1 to side 2, n from 1 to 2 and A the
// area,
//   traction       t = (sigma_1 + sigma_2) n / 2 + k j,   k = beta E / d, d = 3 (V1 + V2) / 4A
//   strain of 1    += A / 2V1 sym(mean j (x) n), and of 2 likewise
// The mean of the stresses and the strain of the jumps are each other's adjoint, so that the whole has an energy: it is
// that of the tets and k j.j / 2. Where nodes are shared, j = 0 and all of these terms vanish. So a uniform stress
// stays uniform whichever nodes are freed. A chunk computes the halves of its own tets, for
// which it reads the nodes of the other side; both halves at once where both tets are its own. The term k j belongs to the face (bond/cohesive_faces.hpp).
#pragma once

#include "libcdem/element/finite_volume.hpp"
#include "libcdem/state/face_state.hpp"

namespace cdem {

// The tets of a chunk and what holds them to the tets beyond their freed faces. Only faces that hold take part.
// position (m), velocity, force: one entry for each place of the chunk.
struct FaceSides {
  const FaceSideBatch* batches = nullptr;
  std::int64_t count = 0, tet_batches = 0;
  const FaceStateBatch* faces = nullptr; // of the model
};

// jumps: of the chunk's batches. dt: s.
void find_jumps(const FaceSides&, const Node* position, const Node* velocity, double dt, JumpBatch* jumps);

// Adds half the tractions of the chunk's tets to both sides of their faces. viscous: null without damping.
void add_side_forces(const FaceSides&, const Node* position, const StressBatch* stress,
                     const StressBatch* viscous, Node* force);

} // namespace cdem
