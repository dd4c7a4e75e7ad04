// Finds the positions at which many rigid bodies of one shape come to rest together. They press on each other and on
// bodies that do not move. All of them move down in small steps, each from rest, without inertia, until friction holds
// them.
//
// They are at rest when no body has moved on in four steps, with gravity tilted in four directions: a body that only
// rocks returns. If a body slides on, the steps become larger again. If a body moves further than `way`, the lowest of
// the bodies that move on is held at its first position, and all begin again. After some such repetitions a body that
// goes too far is held where it is. So are bodies that still move towards the last of the steps.
#pragma once

#include "libgeom/placement/rest.hpp"

namespace geom {

struct RestTogether {
  std::vector<Pose> poses;
  bool still = false; // all of them at rest
  // Bodies that would have moved further than `way`, or did not come to rest: they were held.
  std::vector<char> stayed;
  // How many others, moving or not, press on each with a twentieth of its weight or more; of one that stayed only those
  // that moved. Empty unless still.
  std::vector<int> pressed_by;
};

// For bodies of one shape that press on each other and on others that do not move; `bounds` are not used.
RestTogether come_to_rest_together(const Features& shape, const std::vector<Pose>& start,
                                   const std::vector<const Features*>& others, const RestOptions&);

} // namespace geom
