// A free assembly keeps its momentum and, about the undeformed places that small strain refers to, its
// angular momentum: blocks, bonds, breaking and friction only move it about inside.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/random.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

TEST_CASE("a free assembly keeps its momentum over 1e5 steps, breaking and sliding or not", "[momentum]") {
  const bool breaking = GENERATE(false, true);
  geom::VoronoiOptions cells;
  cells.count = 6;
  cdem::Joint joint = rock_joint();
  joint.cohesion = joint.tensile_strength = 1e4;
  System s(build({body("rock", geom::voronoi(cells), rock(), joint)}));
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
    const auto draw = [&](std::uint64_t k) { return geom::uniform(9, i, k) - 0.5; };
    s.state.velocity[i] = node(Vec3(0.3, -0.2, 0.1) + 0.2 * Vec3(draw(0), draw(1), draw(2)) +
                               Vec3(0.1, 0.2, 0.3).cross(s.model.node_position[i]));
  }
  const Momentum before = momentum(s, Places::undeformed);
  cdem::RunOptions options;
  options.steps = 100000;
  options.breaking = breaking;
  s.run(options);
  const Momentum after = momentum(s, Places::undeformed);
  CHECK((after.linear - before.linear).norm() < 1e-12 * before.linear.norm());
  CHECK((after.angular - before.angular).norm() < 1e-12 * before.angular.norm());
  const auto broken =
      std::count_if(s.state.bond_mode.begin(), s.state.bond_mode.end(), [](auto m) { return m != 0; });
  CHECK((broken > 0) == breaking);
}
