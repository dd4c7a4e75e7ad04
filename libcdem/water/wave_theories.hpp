// The coefficients of steady waves by each theory, from checked input.
#pragma once

#include "libcdem/water/steady_wave.hpp"

namespace cdem {

SteadyWave airy_wave(const WaveGiven&);
// Fenton 1985, "A fifth-order Stokes theory for steady waves", J. Waterway Port Coastal Ocean Eng. 111:216-234. Throws
// geom::InputError for waves too long for it, where H L^2 / d^3 > 40.
SteadyWave stokes_wave(const WaveGiven&);
// Order N: N + 1 points from crest to trough meet the free surface's two conditions exactly (Rienecker and Fenton 1981,
// J. Fluid Mech. 104:119-137), by Newton's method over growing heights.
SteadyWave stream_function_wave(const WaveGiven&);

} // namespace cdem
