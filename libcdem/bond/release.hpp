// Interfaces that are left to contact: an interface between two blocks that move far holds them while its faces lie on
// each other. Once none of its bonds is whole it is handed over to the contact of the surfaces when
//   1. its springs carry nothing and have opened at every point (by 1e-3 of the interface's size), or
//   2. its faces have opened like a hinge (by more than 0.02 rad).
// An interface that has slid, at any of its points, by 0.005 of its size gets new springs where its faces lie on each other
// now (fracture/renew_interfaces.hpp), and with it all that have slid by half as much between blocks that interfaces hold
// together with its own: the model, whose contacts are searched anew then, changes seldom.
// The pressure of water acts on the faces until the interface is left to contact and the faces have moved relative to
// each other, at every point, by 0.05 of the size. Then the water is lost.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// A part of the interface's size. The two forces of a spring that has slid do not lie in one line, and their couple does a
// work that no spring stores or takes.
inline constexpr double slid_too_far = 0.005, slid_enough = 0.0025;

struct Released {
  std::int64_t interfaces = 0;
  double stored = 0;        // J, that their springs held and hold no more
  double water = 0;         // J, that water that is gone had done by opening them
  std::vector<int> slid;    // interfaces that stay and are to get new springs, ascending
  std::vector<char> blocks; // per block, 1 for all that interfaces held together with one of those that leave
};

// Writes State::released, and State::water_pressure where water is gone.
Released release_interfaces(const Model&, State&, int threads);

// Blocks that an interface still holds together, pairs of Model::blocks with the smaller first, ascending: contact
// leaves them alone.
std::vector<std::pair<int, int>> held_pairs(const Model&, const State&);

// Per block: contact has been told that some of its interfaces has a bond that is not whole.
std::vector<char> blocks_with_broken_bonds(const Model&, const State&);

} // namespace cdem
