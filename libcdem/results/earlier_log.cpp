#include "libcdem/results/earlier_log.hpp"

#include <algorithm>

namespace cdem {

void go_back(RunLog& log, std::int64_t last_step, std::size_t breaks, const OneWayEnergies& one_way) {
  log.one_way = one_way;
  forget_breaks(log, breaks);
  const auto erase_later = [&](auto& rows) {
    rows.erase(
        std::remove_if(rows.begin(), rows.end(), [&](const auto& row) { return row.step > last_step; }),
        rows.end());
  };
  erase_later(log.history);
  erase_later(log.escapes);
  for (Watch& watch : log.watches)
    watch = watch_at(watch, last_step);
}

} // namespace cdem
