// Faces of a mesh with springs that have broken or may break now, computed one by one: the law at the top of
// face_bonds.hpp in the axes of the face, the energy of breaking and friction, and the hand-over to the contact of the
// surface.
//
// Energies follow the trapezoidal rule, as central differences require. A spring that slides by ds dissipates (Fs
// before + Fs now) . ds / 2. A spring that breaks dissipates its stored energy, less the half step of work that its
// force would have done.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/bond/face_frame.hpp"
#include "libcdem/parallel/simd.hpp"

namespace cdem {

// Forces of these faces of a batch, a bit each, whose first spring has the place `first_spring`. Replaces the force of the
// three points on side a, N, wherever it is not that of an intact spring.
void one_by_one(const FaceBatch&, unsigned faces, const FaceMotion&, const FaceLaw&, bool breaking,
                std::int64_t first_spring, FaceStateBatch&, FaceSlipBatch*, simd::Vec (&force)[3], FaceSums&);

} // namespace cdem
