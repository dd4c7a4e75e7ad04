// How far the blocks have moved since they were searched.
#pragma once

#include <vector>

namespace cdem {

struct BlockTravel {
  std::vector<double> skin; // m, per block: how far it may go before the next search; written by choose_skins
  std::vector<double> travelled;         // m, per block, at most, since the search
  std::vector<double> last_displacement; // m, per block, of its fastest node in the last step
  double last_step = 0;                  // s, the last one in which anything moved
};

} // namespace cdem
