#include "libcdem/results/log.hpp"

#include <algorithm>

namespace cdem {
namespace {

constexpr std::size_t most_rows = 20000;

}

void RunLog::add(HistoryRow row) {
  history.push_back(std::move(row));
  if (history.size() <= most_rows)
    return;
  every *= 2;
  std::vector<HistoryRow> kept;
  for (std::size_t i = 0; i < history.size(); ++i) {
    const bool first_of_stage = i == 0 || history[i - 1].stage != history[i].stage,
               last_of_stage = i + 1 == history.size() || history[i + 1].stage != history[i].stage;
    if (history[i].step % every == 0 || first_of_stage || last_of_stage)
      kept.push_back(std::move(history[i]));
  }
  history = std::move(kept);
}

void forget_breaks(RunLog& log, std::size_t left) {
  log.breaks.resize(std::min(left, log.breaks.size()));
  log.broken_tension = log.broken_shear = 0;
  for (const BreakRow& row : log.breaks)
    ++(row.mode == BondMode::broken_tension ? log.broken_tension : log.broken_shear);
}

} // namespace cdem
