#include "libcdem/results/watch_carried.hpp"

#include <algorithm>

namespace cdem {

void carry_over(Watch& watch, const std::vector<int>& new_block) {
  for (int& block : watch.blocks)
    block = new_block[block];
  for (std::vector<int>& touched : watch.touched) {
    for (int& block : touched)
      block = new_block[block];
    touched.erase(std::remove(touched.begin(), touched.end(), -1), touched.end());
  }
  std::size_t left = 0;
  for (std::size_t b = 0; b < new_block.size(); ++b)
    if (new_block[b] >= 0) {
      watch.start[left] = watch.start[b];
      watch.gone[left++] = watch.gone[b];
    }
  watch.start.resize(left);
  watch.gone.resize(left);
}

} // namespace cdem
