// Earthquake records: acceleration integrated to velocity (trapezoidal rule), and its baseline correction.
//
//   v(t) = integral of a,   d(t) = integral of v
//
// The noise of a recorder leaves a drift: v and d do not end at rest. The straight baseline a_0 + a_1 t that is taken
// off the acceleration is the one that brings both the last velocity and the last displacement to zero,
//
//   a_0 T + a_1 T^2 / 2 = v(T),   a_0 T^2 / 2 + a_1 T^3 / 6 = d(T)
#pragma once

#include "libcdem/load/time_table.hpp"

namespace cdem {

// Throws geom::InputError where two times are further apart than `longest`; 0: than 2.5 times the median step. lines: of the
// points in their file, for the message.
void require_no_gaps(const TimeTable&, double longest = 0, const std::vector<int>& lines = {});

struct Baseline {
  double constant = 0; // a_0, m/s2
  double slope = 0;    // a_1, m/s3
};

struct VelocityRecord {
  TimeTable velocity;                                    // m/s
  double end_velocity = 0, end_displacement = 0;         // m/s, m, after the baseline
  double raw_end_velocity = 0, raw_end_displacement = 0; // before
  Baseline baseline;
};

// Integrates an acceleration, m/s2; it begins at rest.
VelocityRecord integrate(const TimeTable& acceleration, bool straight_baseline);

double peak(const TimeTable&); // largest magnitude

} // namespace cdem
