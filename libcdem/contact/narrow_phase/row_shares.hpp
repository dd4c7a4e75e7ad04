// Contact with several ranks. Each rank computes the rows that it keeps (broad_phase/search_shares.hpp), and sends its
// contacts to the others. All ranks know all contacts and their forces. A single rank does none of this.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

#include <functional>

namespace cdem {

// Before a search, which looks at all surfaces.
void begin_search(State&, ContactWork&);

// After one: which nodes this rank reads, those at the surface of the blocks and fragments in its rows, and of the fragments
// that it follows. Nodes of blocks whose motion as a whole counts are read by all.
void read_nodes_of_rows(const Model&, ContactWork&);

void add_depths(const ContactSums& more, ContactSums& sums); // the deepest; the first of equals
void append(const ContactChunk& more, ContactChunk& sum);

// What all ranks have found, springs and edges, by rank, in the order of their sources.
std::array<std::vector<ContactChunk>, 2> found_by_all(const std::array<ContactChunk, 2>& own);

// A number for each of these of State::contacts, worked out by the rank that found it in the step before, or by all right
// after a search.
std::vector<double> of_finders(const ContactWork&, const std::vector<std::size_t>& contacts,
                               const std::function<double(std::size_t)>& number);

} // namespace cdem
