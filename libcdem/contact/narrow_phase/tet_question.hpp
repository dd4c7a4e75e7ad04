// Which pairs of tetrahedra are looked at in a step.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/data/tet_contacts.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct AskedPair {
  std::size_t near = 0;            // of TetContacts::near
  const Contact* before = nullptr; // null: there was none
};

// What stands in State of pairs that sleep stays, and is set between the others.
struct TetQuestion {
  std::vector<const Contact*> ended; // their pairs may not touch any more
  std::vector<AskedPair> asked;
  std::vector<std::pair<std::size_t, const Contact*>> asleep; // before which of `asked`
};

TetQuestion tet_question(const State&, ContactWork&);

} // namespace cdem
