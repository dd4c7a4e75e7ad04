// The semi-edges of the surfaces as they are now: those of the outside, and those that faces bring which have broken and
// been handed over to contact.
//
// Around an edge of the mesh the triangles that are outside bound wedges of what holds together: seen along the edge,
// undeformed, a wedge goes from a triangle with the inside at larger angles to the next with the inside at smaller ones.
// It is a semi-edge when it is narrower than a flat angle.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes ContactWork::edges, edge_begin, edge_ends and edges_at; fragments are known.
void find_semi_edges(const Model&, const State&, ContactWork&);

} // namespace cdem
