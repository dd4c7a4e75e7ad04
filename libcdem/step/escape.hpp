// Pieces that leave the model, because they fall off their support or fly out. The user is warned once for each piece,
// and the run goes on.
//
// The distance of a piece is that of the mean of its nodes from the model's undeformed box. Beyond `told_beyond` it has
// left. Beyond `held_beyond` it is held where it is for the rest of the run, since it cannot meet anything there and
// would only get faster. Pieces that a support holds or moves never leave, and neither does the last piece of a model.
#pragma once

#include "libcdem/load/resolve.hpp"
#include "libcdem/state/state.hpp"

#include <limits>
#include <string>
#include <vector>

namespace cdem {

struct EscapeLimits { // m; infinite: nothing leaves
  double told_beyond = std::numeric_limits<double>::infinity();
  double held_beyond = std::numeric_limits<double>::infinity();
};

struct Escape {
  std::string name;                      // of the piece, as a user knows it
  geom::Vec3 place = geom::Vec3::Zero(); // m
  double speed = 0;                      // m/s
  bool held = false;                     // from now on
};

// Some of these nodes are where a piece that has left may be.
bool any_is_out(const Model&, const State&, const EscapeLimits&, Range nodes);

// Those that have left, or are held, since the last look; State::escaped says so from then on.
std::vector<Escape> find_escapes(const Model&, State&, const ResolvedConditions&, const EscapeLimits&);

} // namespace cdem
