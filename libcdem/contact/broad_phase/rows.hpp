// From pairs that are near each other to rows: all targets near one source, of one fragment.
#pragma once

#include "libcdem/contact/broad_phase/candidates.hpp"

namespace cdem {

// What a search finds anew: all, or what is near the blocks on which fragments are not what they were. The rows of all others
// stay as they are.
struct Renewed {
  bool all = true;          // blocks; but rigid pairs may keep their rows
  std::vector<char> blocks; // per block
  // Per block: by how much the numbers of its edges are larger than they were. Empty: as before.
  std::vector<int> edge_shift;
  // Per rigid pair as it was numbered before, its number now; -1: its rows are found anew.
  std::vector<int> pair_now;
};

// Writes ContactWork::rows of one kind: those that stay, and those of `parts`.
void make_rows(const Model&, ContactWork&, const SearchMargin&, const std::vector<std::vector<Near>>& parts,
               Contact::Kind, const Renewed&);

} // namespace cdem
