// Contact with several ranks: each looks at a run of chunks of rows, cut by the number of candidates, and tells the others
// what it found. All of them know all contacts and their forces. By one rank alone nothing of it happens.
//
// What is known of a row that sleeps is known by the rank that has looked at it: where a search hands a row to another,
// it is woken. That changes no force.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

#include <functional>

namespace cdem {

// Before a search, which looks at everything.
void begin_search(State&, ContactWork&);

// After one: whose the rows are now, and which nodes this rank reads for its own: those at the surface of all that stands
// in them. Nodes of what has broken, and of blocks whose motion as a whole counts, are read by all.
void share_rows(const Model&, ContactWork&);

Range own_chunks_of_rows(const ContactWork&, std::int64_t chunks);

void add_depths(const ContactSums& more, ContactSums& sums); // the deepest; the first of equals
void append(const ContactChunk& more, ContactChunk& sum);

// By rank.
std::vector<ContactChunk> found_by_all(const ContactChunk& own);

// A number for each of these of State::contacts, worked out by the rank that found it in the step before, or by all right
// after a search.
std::vector<double> of_finders(const ContactWork&, const std::vector<std::size_t>& contacts,
                               const std::function<double(std::size_t)>& number);

} // namespace cdem
