// The pressure of a flow on outer faces as they stand now (Feng 2014 eqs 19-20).
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

// Nodal forces at a pressure of 1 Pa, N: a third of each facing face's A (d . n) d at its corners.
std::vector<std::pair<int, geom::Vec3>> flow_pattern(const Model&, const State&, const ResolvedFlow&);

// Areas of all its faces, whichever way they look, m2: a third of each face's area along its inward normal at its corners.
std::vector<std::pair<int, geom::Vec3>> inward_areas(const Model&, const State&, const ResolvedFlow&);

} // namespace cdem
