// How fast the forces of an excavation go.
#pragma once

namespace cdem {

struct Excavation {
  double relaxed = 1; // lambda of convergence-confinement, 0 to 1: the share of the forces that goes
  double over = 0;    // s, of a run, in which it goes evenly; 0: at once
};

// Throws geom::InputError naming the field, its value and the allowed range.
void check(const Excavation&);

} // namespace cdem
