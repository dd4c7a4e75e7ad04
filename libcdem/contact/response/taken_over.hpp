// The force of a broken face goes over to the contact of its two tetrahedra, so that nothing jumps when the face is handed
// over: phi0 of the contact (tet_potential.hpp) becomes such that its normal force is that of the face, and what acts along
// the face becomes its shear force. A face that does not press leaves nothing.
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
