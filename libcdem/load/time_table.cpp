#include "libcdem/load/time_table.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {

double TimeTable::at(double t) const {
  if (t < time.front())
    return zero_outside ? 0 : value.front();
  if (t >= time.back())
    return zero_outside && t > time.back() ? 0 : value.back();
  const auto next = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
  const double share = (t - time[next - 1]) / (time[next] - time[next - 1]);
  return value[next - 1] + share * (value[next] - value[next - 1]);
}

void validate(const TimeTable& table) {
  if (table.time.size() != table.value.size())
    throw geom::InputError(fmt::format("a table over time has {} times and {} values: give as many of both",
                                       table.time.size(), table.value.size()));
  if (table.time.size() < 2)
    throw geom::InputError(
        fmt::format("a table over time has {} point{}: give two at least, the first and the last",
                    table.time.size(), table.time.size() == 1 ? "" : "s"));
  for (std::size_t i = 0; i < table.time.size(); ++i) {
    if (!std::isfinite(table.time[i]) || !std::isfinite(table.value[i]))
      throw geom::InputError(
          fmt::format("point {} of a table over time is ({:g}, {:g}): give finite numbers, "
                      "and leave out what was not measured",
                      i + 1, table.time[i], table.value[i]));
    if (i > 0 && table.time[i] <= table.time[i - 1])
      throw geom::InputError(
          fmt::format("point {} of a table over time: its time, {:g} s, does not come after "
                      "{:g} s of the point before; sort the rows and drop double ones",
                      i + 1, table.time[i], table.time[i - 1]));
  }
}

} // namespace cdem
