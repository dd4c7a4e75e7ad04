#include "libcdem/step/step_times.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {

const char* name(StepLine line) {
  constexpr const char* names[step_lines] = {"contact search", "contacts", "loads",        "cracks",
                                             "bonds",          "elements", "shared nodes", "rigid bodies",
                                             "ranks",          "watch",    "callbacks"};
  return names[static_cast<std::size_t>(line)];
}

double StepTimes::share(StepLine line) const {
  const auto all = static_cast<double>(std::accumulate(spent_.begin(), spent_.end(), std::int64_t{0}));
  return all > 0 ? static_cast<double>(spent_[static_cast<std::size_t>(line)]) / all : 0;
}

std::string StepTimes::text() const {
  std::array<StepLine, step_lines> lines;
  for (std::size_t i = 0; i < step_lines; ++i)
    lines[i] = static_cast<StepLine>(i);
  std::stable_sort(lines.begin(), lines.end(), [&](StepLine a, StepLine b) { return share(a) > share(b); });
  std::string text;
  for (const StepLine line : lines)
    if (const long percent = std::lround(100 * share(line)); percent > 0)
      text += (text.empty() ? "" : ", ") + std::string(name(line)) + " " + std::to_string(percent) + " %";
  return text;
}

} // namespace cdem
