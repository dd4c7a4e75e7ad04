// Speeds of waves in an isotropic elastic solid, m/s: dilatational, shear, and along a free surface (Rayleigh 1885).
#pragma once

#include "libcdem/material/elastic.hpp"

namespace cdem {

double dilatational_speed(const Elastic&); // c_d, sqrt((lambda + 2 G) / rho)
double shear_speed(const Elastic&);        // c_s, sqrt(G / rho)

// c_R, the root below c_s of Rayleigh's equation; to rounding.
//   (2 - c^2/c_s^2)^2 = 4 sqrt(1 - c^2/c_d^2) sqrt(1 - c^2/c_s^2)
double rayleigh_speed(const Elastic&);

} // namespace cdem
