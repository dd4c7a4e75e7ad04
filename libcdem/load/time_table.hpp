// A quantity over time as a table: linear between its points. It needs no script to be evaluated, so a step that reads
// it is as fast and as repeatable as one with constant loads.
#pragma once

#include <vector>

namespace cdem {

struct TimeTable {
  std::vector<double> time;  // s, ascending
  std::vector<double> value; // as many
  // Before the first and after the last time: 0, as of an earthquake record. Otherwise the first and the last value.
  bool zero_outside = false;

  double at(double time) const;
};

// Throws geom::InputError unless there are two points at least, all finite, with times that grow.
void validate(const TimeTable&);

} // namespace cdem
