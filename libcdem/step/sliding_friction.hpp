// Whether bodies that slide have the friction of their law. While the sole of a deformable body vibrates, the slip of some of
// its contacts reverses, others stick, and the sum of their friction is less (Adams 1998, J. Appl. Mech. 65, 470-475).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace cdem {

struct Model;
struct State;

struct SlidingFriction {
  // Of two bodies, smaller first, over the contacts between a block that deforms and another one. v: slip of the two blocks
  // there if each moved as a rigid body, w: of the contact itself, both along its face.
  struct Sums {
    double law = 0;     // J, sum of tan(phi) N |v| dt
    double done = 0;    // J, sum of the work of friction on v
    double slip = 0;    // N m2/s, sum of N v.v dt
    double contact = 0; // N m2/s, sum of N v.w dt: as much as `slip` where the sole goes with the body
    std::int64_t looks = 0;

    bool slides() const { return contact > 0.7 * slip && contact < 1.3 * slip; }
  };
  std::map<std::array<int, 2>, Sums> of_bodies;
  double last_look = 0; // s

  // Some hundred steps after the last time. broken: per block; pieces move by themselves and do not count.
  void look(const Model&, const State&, const std::vector<char>& broken);
};

} // namespace cdem
