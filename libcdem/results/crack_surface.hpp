// Cracks as a surface: the faces whose bonds have broken, and those that soften where they are asked for, midway between
// their two sides.
//
// Corners have "displacement" (m, mean of both sides). Faces have "mode" (BondMode, the worst of its bonds), "damage"
// (mean), "opening" and "slip" (m, means, along the normal of the face and in it), "time" (s, of its last break; NaN where
// it is not known: whole bonds, and those cut since they broke) and "body" (its number; -1 between two bodies).
#pragma once

#include "libcdem/results/log.hpp"
#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// A Snapshot of bonds alone. damaged: also faces with some damage, else only those all of whose bonds are broken.
Snapshot crack_surface(const Model&, const State&, const std::vector<BreakRow>& breaks, bool damaged,
                       const std::string& title);

} // namespace cdem
