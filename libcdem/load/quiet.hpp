// Quiet boundary (Lysmer and Kuhlemeyer 1969): dashpots on outer faces with the impedance of the rock behind them. With
// the outward normal n they pull with
//
//   t = -Z v + 2 Z w + 2 s,   Z = rho c_p n n^T + rho c_s (I - n n^T)
//
// w is the particle velocity, s the traction of an incoming wave. Half of the term is the traction of the wave itself;
// the other half compensates the dashpot, which absorbs the same amount. A P or S wave that arrives along n leaves
// completely.
#pragma once

#include "libcdem/load/resolve.hpp"

#include <map>

namespace cdem {

geom::Mat3 wave_impedance(const Elastic&, const geom::Vec3& normal); // Z, Pa s/m; normal: unit

// Dashpots by node, N s/m.
using Dashpots = std::map<int, geom::Mat3>;

// Adds the dashpots of the selected outer faces. Throws geom::InputError where there is none, and on rigid bodies.
// Returns the faces.
std::vector<int> add_dashpots(const Model&, const Selection&, const char* call, Dashpots&);

// Nodal forces of an entering wave at amplitude 1, N.
std::vector<std::pair<int, geom::Vec3>> entering_wave(const Model&, const std::vector<int>& faces,
                                                      const Quiet&);

} // namespace cdem
