// A factor over time as a script gives it: a table, or a function of its own.
#pragma once

#include "lua/binding/module/record.hpp"

#include "libcdem/load/conditions.hpp"
#include "libcdem/load/time_table.hpp"

namespace cdem::script {

// cdem.Record: a table over time, and what cdem.record tells of one that it read.
struct Recorded : TimeTable {
  std::optional<double> peak{}, duration{}, end_velocity{}, end_displacement{};
  std::optional<std::string> unit{};
  std::optional<std::vector<double>> baseline{};
};
const Record<Recorded>& recorded();

// "amplitude": factor over time (s), 1 when left out.
Field amplitude_field();
// "since": when its times begin (s), beside every amplitude.
Field since_field();
// A function is tried at the model's time `now`, s, so that a slip in it is an error of the line that gave it.
Amplitude amplitude_of(const Arguments&, double now);

} // namespace cdem::script
