// Bars of concrete that may crack anywhere, drawn apart.
#pragma once

#include "tests/libcdem/cohesive_concrete.hpp"

namespace testing {

// The ends along x move apart, each at half of `speed` (m/s).
template <class Fixes>
void lead_apart(Fixes& to, double speed) {
  for (const double side : {-1.0, 1.0}) {
    cdem::Fix lead = fixed(cdem::Selection::side(side < 0 ? "x-" : "x+"), "x");
    lead.velocity = geom::Vec3(0.5 * side * speed, 0, 0);
    to.push_back(lead);
  }
}

// Mean traction on the side x+ of a box, Pa.
inline double end_traction(const System& s, double area) {
  const std::vector<geom::Vec3> forces = s.net_forces();
  double sum = 0;
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (std::abs(s.model.node_position[i].x() - s.model.box.max.x()) < 1e-9)
      sum -= forces[i].x();
  return sum / area;
}

} // namespace testing
