#include "libcdem/contact/broad_phase/block_travel.hpp"

#include "libcdem/ranks/shared_state.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

std::vector<double> speeds_of_blocks(const Model& model, const State& state, const ContactWork& work,
                                     int threads) {
  std::vector<double> speeds(model.blocks.size(), 0.0);
  const Range own = work.shared->part().nodes();
  for_chunks(static_cast<std::int64_t>(speeds.size()), threads, [&](std::int64_t b) {
    const Block& block = model.blocks[b];
    if (!block.meshed)
      return;
    const auto begin = std::max<std::int64_t>(block.node_begin, own.begin),
               end = std::min<std::int64_t>(block.node_end, own.end);
    double speed2 = 0;
    for (auto node = static_cast<int>(begin); node < end; ++node)
      speed2 = std::max(speed2, velocity_of(state, node).squaredNorm());
    speeds[b] = std::sqrt(speed2);
  });
  if (!work.shared->alone())
    ranks().largest(speeds.data(), speeds.size());
  return speeds;
}

} // namespace cdem
