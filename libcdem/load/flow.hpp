// The pressure of a flow on outer faces as they stand now (Feng 2014 eqs 19-20).
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

// Nodal forces at a pressure of 1 Pa, N: a third of each facing face's A (d . n) d at its corners.
std::vector<std::pair<int, geom::Vec3>> flow_pattern(const Model&, const State&, const ResolvedFlow&);

// All its faces, whichever way they look: a third of each face's area along its inward normal at its corners.
std::vector<FlowCorner> flow_corners(const Model&, const State&, const ResolvedFlow&);

// Outer faces that a flow may meet, ascending: not those of cavities that a mesh closes. shells: of_inner_shells.
std::vector<int> flow_faces(const Model&, const Flow&, const std::vector<int>& shells);
std::vector<int> flow_faces(const Model&, const Flow&);

// Outward, unit, of a face of a convex block where it stands now; a block of small strain hardly turns.
geom::Vec3 present_normal(const Model&, const State&, const OuterFace&);

} // namespace cdem
