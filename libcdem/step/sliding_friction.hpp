// Whether bodies that slide have the friction of their law. While the sole of a deformable body vibrates, the slip of some of
// its contacts reverses, others stick, and the sum of their friction is less (Adams 1998, J. Appl. Mech. 65, 470-475).
#pragma once

#include "libgeom/core/types.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace cdem {

struct BondWork;
struct Model;
struct State;

struct SlidingFriction {
  // Sums over the contacts of two blocks, smaller first, of which one deforms, and over the springs between them that are
  // contacts. v: slip of the two there if each moved as a rigid body, w: of the contact itself, both along its face.
  struct Sums {
    // N m, sum of tan(phi) N v dt, of the first past the second: what shakes to and fro does not count.
    geom::Vec3 law = geom::Vec3::Zero();
    double done = 0;        // J, sum of the work of friction on v
    double path = 0;        // J, sum of tan(phi) N |v| dt
    double slip = 0;        // N m2/s, sum of N v.v dt
    double contact = 0;     // N m2/s, sum of N v.w dt: as much as `slip` where the sole goes with the body
    double span = 0;        // J s, sum of tan(phi) N L dt, L the edge of a cube as large as the smaller block
    double time = 0;        // s
    std::int64_t looks = 0; // that found more than a hundredth of the path so far
    bool joint = false;     // springs are among them

    // The soles go with the blocks, which on the whole have moved past each other by more than what gives. Where friction does
    // less than half of what its law asks for, they stick and roll over each other.
    bool slides() const {
      return looks >= 10 && contact > 0.7 * slip && contact < 1.3 * slip && law.norm() * time > 1e-4 * span &&
             done > 0.5 * law.norm();
    }
  };
  std::map<std::array<int, 2>, Sums> of_blocks;
  std::size_t blocks = 0; // of the model that they belong to

  // time: s, since the last look, some hundred steps ago. broken: per block; pieces move by themselves and do not count.
  // Joints with a law of their own do not count either.
  void look(const Model&, const State&, const BondWork&, const std::vector<char>& broken, double time);
};

} // namespace cdem
