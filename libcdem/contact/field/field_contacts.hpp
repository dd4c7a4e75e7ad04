// Forces of the pressure field on one chunk of rows: normal forces by the exact gradient of the energy
// (triangle_in_tet.hpp, edge_in_tet.hpp), and friction by one tangential spring for each source and other block,
//   F <- F - ks du,   |F| <= N tan(phi),   ks = ks/kn sum K |grad phi| A over the clipped areas A,
// kept in the frame of the source's triangle: nothing moves from cell to cell. It acts on each cell's part of the source
// in proportion to its normal force.
//
// ks changes as the area does. Where it grows the force stays, where it falls the stretch does: the spring never gains
// what nobody gave it, and what it loses is booked as friction.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem::field {

// Writes ContactWork::field_place for the blocks that are near another.
void find_field_places(const Model&, const State&, ContactWork&, int threads);

// Rows [begin, end) of ContactWork::field_rows.
void field_contacts(const Model&, const State&, ContactWork&, std::int64_t begin, std::int64_t end,
                    ContactChunk& out);

} // namespace cdem::field
