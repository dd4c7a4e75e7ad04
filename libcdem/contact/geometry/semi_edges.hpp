// The semi-edges of the present surfaces: edges of the outside, and edges of faces that have broken and been handed
// over to contact.
//
// Around an edge of the mesh, the outer triangles bound wedges of connected material. Seen along the undeformed edge, a
// wedge reaches from a triangle with its inside at larger angles to the next triangle with its inside at smaller
// angles. A wedge is a semi-edge if it is narrower than a flat angle.
#pragma once

#include "libcdem/contact/data/contact_fragments.hpp"
#include "libcdem/contact/data/surface_edges.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// known: SurfaceEdges::of_broken of the search before, of the same model; empty: none is known.
SurfaceEdges find_semi_edges(const Model&, const State&, const ContactFragments&,
                             std::vector<EdgesOfBroken> known = {});

} // namespace cdem
