// Contact with several ranks. Each rank computes the rows that it keeps (data/row_owner.hpp). All ranks know the
// contacts of bodies that deform; of the contacts of two rigid bodies a rank knows its own. A single rank does none of
// this.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Before a search, which looks at all surfaces and contacts.
void begin_search(State&, ContactWork&);

// After one: which nodes this rank reads, those at the surface of the blocks and fragments in its rows, and of the fragments
// that it follows. Nodes of blocks whose motion as a whole counts are read by all. Rigid bodies are read as wholes.
void read_nodes_of_rows(const Model&, ContactWork&);

// Where State::contacts are those of all ranks: leaves out what this one does not need.
void keep_own_contacts(const Model&, State&, ContactWork&);

} // namespace cdem
