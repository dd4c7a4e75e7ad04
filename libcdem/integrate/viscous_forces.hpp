// Viscosity of materials at nodes, which resists their velocity: mu m / rho, so that every motion fades at the rate mu / rho.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

std::vector<double> viscous_forces(const Model&); // N s/m (n_nodes); empty when nothing is viscous

} // namespace cdem
