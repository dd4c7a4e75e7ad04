// What a search finds anew: all, or what is near the blocks on which fragments are not what they were. The rows of all others
// stay as they are.
#pragma once

#include <vector>

namespace cdem {

struct Renewed {
  bool all = true;          // blocks; but rigid pairs may keep their rows
  std::vector<char> blocks; // per block
  // Per block: by how much the numbers of its edges are larger than they were. Empty: as before.
  std::vector<int> edge_shift;
  // Per rigid pair as it was numbered before, its number now; -1: its rows are found anew.
  std::vector<int> pair_now;
};

} // namespace cdem
