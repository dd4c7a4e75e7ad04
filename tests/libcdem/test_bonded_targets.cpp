// Blocks that bonds hold together are one target: its nearest triangle may lie on any of them, and each of them moves.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "tests/libcdem/boxes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace testing;

namespace {

constexpr double clear = 5e-4, pace = 0.1; // m, m/s

// Two cubes of 1 m side by side, with a soft joint between them, and a plate that stands still above the joint. One cube
// is held, the other one is led up to the plate. held_first: the held cube has the lower number.
System two_cubes_below_a_plate(bool held_first) {
  cdem::Joint soft = rock_joint();
  soft.normal_stiffness = soft.shear_stiffness = 1e8;
  soft.tensile_strength = soft.cohesion = 1e12;
  cdem::BodySpec pair = body("pair", geom::grid({2, 1, 1}, {2, 1, 1}), rock(), soft);
  cdem::BodySpec plate =
      body("plate", geom::grid({1, 0.4, 0.4}, {1, 1, 1}, {held_first ? 0.8 : 0.2, 0.3, 1 + clear}));
  pair.element = cdem::Element::finite_volume;
  plate.element = cdem::Element::rigid;
  System s(build({pair, plate}, {{"pair", "plate", friction(30)}}));
  s.hold(body_of("plate"), "xyz");
  s.hold(cdem::Selection::side(held_first ? "x-" : "x+"), "xyz");
  cdem::Fix lead = fixed(cdem::Selection::side(held_first ? "x+" : "x-"), "z");
  lead.velocity = geom::Vec3(0, 0, pace);
  s.conditions.fixes.push_back(lead);
  return s;
}

struct Met {
  double depth = 0, reference_depth = 0; // m, of semi-springs, the largest that there were
  std::uint64_t hash = 0;
};

Met met(bool held_first, bool looks_at_all) {
  System s = two_cubes_below_a_plate(held_first);
  Met found;
  cdem::RunOptions options;
  options.duration = 1.5 * clear / pace;
  options.looks_at_all_contacts = looks_at_all;
  options.callback_every = 1;
  options.callback = [&] {
    for (const cdem::Contact& c : s.state.contacts)
      if (c.kind == cdem::Contact::spring) {
        found.depth = std::max(found.depth, c.depth);
        found.reference_depth = std::max(found.reference_depth, c.reference_penetration);
      }
  };
  s.run(options);
  found.hash = cdem::hash(s.state);
  return found;
}

} // namespace

TEST_CASE("bonded blocks: a contact begins in time on whichever of them moves", "[contact][moving]") {
  const bool held_first = GENERATE(true, false);
  const Met all = met(held_first, true), skipped = met(held_first, false);
  INFO("held first " << held_first << ", depth " << all.depth << " and " << skipped.depth
                     << " m, of it without force " << skipped.reference_depth << " m");
  CHECK(all.depth > 0);
  CHECK(skipped.reference_depth == 0); // it came from outside, so all of its depth carries
  CHECK(skipped.hash == all.hash);
}
