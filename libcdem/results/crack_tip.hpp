// The tip of a crack along a path, and its speed, from the bonds that broke.
//
// A broken point belongs to the corridor when it lies within `width` of the path (undeformed). Points that lie within
// `reach` of each other are connected. The tip is the position along the path, from its first corner, of the farthest
// point that is connected with the start, that is with a point within `reach` of the first corner. A microcrack ahead
// counts once the crack has reached it.
//
// The tip s(t) rises in steps. Its speed is the slope of the straight line that fits s(t) best in the mean over the
// time window of length T around tc (least squares over continuous time, exact for a staircase too):
//   v = 12 / T^3 integral (t - tc) s(t) dt
// Near the ends of the record the window is cut off there.
#pragma once

#include "libcdem/results/log.hpp"

#include <optional>

namespace cdem {

struct CrackLine {
  std::vector<geom::Vec3> corners; // m, undeformed, at least two; the first where the crack starts
  double width = 0;                // m, > 0
  double reach = 0;                // m, > 0
};

struct CrackTipRow {
  int stage = 0;
  std::int64_t step = 0;                 // within the stage
  double time = 0;                       // s
  double position = 0;                   // m along the path
  geom::Vec3 place = geom::Vec3::Zero(); // m, of the broken point, undeformed
  double speed = 0;                      // m/s; NaN where no time passes
};

// Where the tip moved on, in order: one row for each step at which it did.
std::vector<CrackTipRow> crack_tip(const std::vector<BreakRow>&, const CrackLine&);

// Fills in the speeds; window: s, > 0.
void add_speeds(std::vector<CrackTipRow>&, double window);

// The mean distance of neighbouring broken points in the corridor, root of 3 A with A the area of a point (a third of a
// triangle); 0 where nothing has broken there.
double usual_distance(const std::vector<BreakRow>&, const std::vector<geom::Vec3>& corners, double width);

} // namespace cdem
