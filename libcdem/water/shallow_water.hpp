// Shallow water over a bed in one dimension, with the depth h and the flow q = h u of each cell:
//
//   h_t + q_x = 0,   q_t + (q^2 / h + g h^2 / 2)_x = -g h b_x - f u |u|
//
// Finite volumes of second order (minmod slopes, two-stage Runge-Kutta) with the hydrostatic reconstruction of Audusse and
// others (2004, SIAM J. Sci. Comput. 25:2050-2065) and the flux of Harten, Lax and van Leer. Depths stay >= 0, and water at
// rest stays at rest to rounding. A breaking wave is a bore: there is no jet, and no pressure of an impact.
#pragma once

#include <functional>
#include <vector>

namespace cdem {

struct ShallowWater {
  double cell = 0;          // m
  std::vector<double> bed;  // m, z at the middle of each cell
  std::vector<double> h, q; // m, m2/s
  double gravity = 9.81;    // m/s2
  double friction = 0;      // f
  double still_depth = 0;   // m, at the open end, the first cell's outer face
  // m over still water, of the wave that enters through the open end as a simple wave; waves that come back leave through
  // it. Empty: a wall. The far end is a wall.
  std::function<double(double time)> entering;

  double longest_step() const; // s, stable
  void step(double time, double dt);
  double velocity(std::size_t i) const; // m/s, 0 where it is dry
  double dry_depth() const { return 1e-6 * (still_depth > 0 ? still_depth : 1); }
};

} // namespace cdem
