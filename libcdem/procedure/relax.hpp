// Dynamic relaxation (Han 2010 eq 12) with fictitious masses and adaptive damping.
//
// With a unit step, central differences are stable for m >= sum_j |K_ij| / 4 (Gershgorin), so these are the masses.
// Critical damping of the mode that moves is c = 2 sqrt(lambda) with lambda = -du . dF / (du . M du), its Rayleigh
// quotient, smoothed over the steps; dF the change of the net force over the displacement increment du.
#pragma once

#include "libcdem/step/options.hpp"
#include "libcdem/step/stage.hpp"

namespace cdem {

// kind: what progress reports call it.
RelaxResult relax(const StageContext&, const RelaxOptions&, const std::string& kind = "relax");

} // namespace cdem
