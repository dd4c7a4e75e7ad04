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

// What a broken face that has parted or slid away lets go of; it is handed over once all its springs are open, or it has slid
// off. size: m, of the face; energy: J, stored in its springs. Returns what of it is lost, J.
double let_go(const FaceFrame&, double size, double energy, int lane, FaceStateBatch&, FaceSums&);

} // namespace cdem
