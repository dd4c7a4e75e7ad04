// Work of the water in joints (load/water.hpp): pressure times area times opening, summed over the springs. A constant
// pressure has this potential, so its work needs no sum over steps.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// J, of the present pressures, counted from closed joints. set_water puts what the
// pressures had done when they were set into State::spent.
double water_work(const Model&, const State&);
double water_work(const Model&, const State&, const Interface&);

} // namespace cdem
