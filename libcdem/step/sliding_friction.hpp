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
  // contacts, from the first look on that finds their friction used up. v: slip of the two there if each moved as a rigid
  // body, w: of the contact itself, both along its face.
  struct Sums {
    // N m, sum of tan(phi) N v dt, of the first past the second: what shakes to and fro does not count.
    geom::Vec3 law = geom::Vec3::Zero();
    double done = 0;    // J, sum of the work of friction on v
    double path = 0;    // J, sum of tan(phi) N |v| dt
    double slip = 0;    // N m2/s, sum of N v.v dt
    double contact = 0; // N m2/s, sum of N v.w dt: as much as `slip` where the sole goes with the body
    double span = 0;    // J s, sum of tan(phi) N L dt, L the edge of a cube as large as the smaller block
    double time = 0;    // s, for which they pressed on each other
    double hops = 0;    // s, for which they did not between two looks that are near to each other
    double end = 0;     // s, the last look that found them pressing
    // m and rad, by which the first moved past the second and turned where they pressed on each other.
    geom::Vec3 way = geom::Vec3::Zero(), turned = geom::Vec3::Zero();
    double size = 0;        // m, L
    std::int64_t looks = 0; // that found more than a hundredth of the path so far
    bool joint = false;     // springs are among them

    // Where friction does less than half of what its law asks for, blocks stick and roll over each other.
    bool slides() const { return done > 0.5 * law.norm() && (goes_with_its_sole() || bounces()); }

    // The soles go with the blocks, which on the whole have moved past each other by more than what gives.
    bool goes_with_its_sole() const {
      return looks >= 10 && contact > 0.7 * slip && contact < 1.3 * slip && way_over_size() > 1e-4;
    }
    // A body that sticks and is sheared does not hop, one that falls or is thrown flies for longer, and one that rolls turns.
    bool bounces() const {
      return looks >= 5 && hops > 0.15 * (time + hops) && way_over_size() > 1e-3 &&
             turned.norm() * size < 0.3 * way.norm();
    }

  private:
    double way_over_size() const { return span > 0 ? law.norm() * time / span : 0; }
  };
  std::map<std::array<int, 2>, Sums> of_blocks;
  std::uint64_t blocks = 0; // of the model that they belong to
  double seen = 0;          // s, of the last look, or when the stage began
  // Bodies that have been told of, as they slide with less than their friction: noted by whoever looks at a result.
  mutable std::vector<std::array<int, 2>> told;

  // Some hundred steps after the last look. broken: per block; pieces move by themselves and do not count. Joints with a law
  // of their own do not count either.
  void look(const Model&, const State&, const BondWork&, const std::vector<char>& broken);
};

} // namespace cdem
