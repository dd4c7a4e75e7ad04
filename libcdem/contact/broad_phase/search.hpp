// Which triangles and edges are near each other: boxes of blocks on a uniform grid, then those of their triangles.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Faces that bonds may hold: what they let go of is in contact at whatever depth.
inline bool any_bonded_faces(const Model& model, const State& state) {
  return !state.face_slip.empty() || !model.mesh.sides.empty();
}

void start_contact(const Model&, ContactWork&);

// Renews rows and candidates for where the nodes are. Throws SolutionError when two bodies meet for which no contact
// is given. False, with nothing done, when a place is not a number.
bool search_contacts(const Model&, const State&, ContactWork&, int threads);

// Beyond this depth a contact is not to be trusted: a quarter of the shallower tet's height, m.
double depth_limit(const SurfaceSizes&, const ContactTriangle&, const ContactTriangle&);

} // namespace cdem
