// The force of a broken face goes over to the contacts of its two triangles, so that nothing jumps when the face is handed
// over. The semi-springs at a corner of the face, one on each side, share the force at that corner, as far as they touch.
// A share is normal (N) and shear (S). The contact had Fn, Fs before and then has
//   Fn' = Fn + N,   Fs' = Fs + S,   k' = Fn'^2 / (Fn^2 / k + N^2 / k_face),   d0' = d - Fn' / k'
// with k_face the part of the stiffness of the face's springs that goes with the share. So the normal force is continuous, the
// two normal springs store together what they stored before, and the contact is never stiffer than both of them.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct FaceToTakeOver {
  std::int64_t face = 0; // batch * lanes + lane in MeshData::faces
  int block = 0;
  const FaceLeft& left;
};

// Writes State::contacts. Returns what was stored in the face and is no longer, J.
double take_over(const Model&, State&, const ContactWork&, const FaceToTakeOver&);

} // namespace cdem
