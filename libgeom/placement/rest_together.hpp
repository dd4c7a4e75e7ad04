// Where many rigid bodies of one shape come to rest together, pressing on each other and on others that do not move:
// all of them go down in small steps, each from rest, without inertia, until friction holds them.
//
// They are at rest when in four steps, of gravity tilted four ways, none has gone on: what only rocks comes back. Where
// one slides on and on steps become larger again. Where one goes further than `way`, the
// lowest of those that go on stays where it was, and all begin again; after some such times what goes too far is put
// back at once.
#pragma once

#include "libgeom/placement/rest.hpp"

namespace geom {

struct RestTogether {
  std::vector<Pose> poses;
  bool still = false; // all of them at rest
  // Those that would have gone further than `way`: they are where they were.
  std::vector<char> stayed;
  // How many others, moving or not, press on each with a twentieth of its weight or more; of one that stayed only those
  // that moved. Empty unless still.
  std::vector<int> pressed_by;
};

// For bodies of one shape that press on each other and on others that do not move; `bounds` are not used.
RestTogether come_to_rest_together(const Features& shape, const std::vector<Pose>& start,
                                   const std::vector<const Features*>& others, const RestOptions&);

} // namespace geom
