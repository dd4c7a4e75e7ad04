// The force of a broken face goes over to the contact of its two tetrahedra, so that nothing jumps when the face is handed
// over: when the pair is next computed, its offset becomes that at which it carries the normal part N of the force
// (contact/pairs/pair_law.hpp), and the rest S is its shear force.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes State::tet_contacts. face: batch * lanes + lane in MeshData::faces. Returns what is lost of what was stored in the face, J.
double take_over(const Model&, State&, std::int64_t face, const FaceLeft&);

} // namespace cdem
