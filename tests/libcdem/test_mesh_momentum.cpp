// A free meshed body keeps its momentum, and its angular momentum about a fixed point.
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

TEST_CASE("finite volume: a free bonded body keeps its momentum over 1e5 steps", "[momentum][mesh]") {
  const bool breaking = GENERATE(false, true);
  cdem::Joint joint = rock_joint();
  joint.cohesion = joint.tensile_strength = 1e4;
  cdem::Bonding bonding;
  bonding.everywhere = true;
  System s(build({meshed("rock", geom::box_mesh({1, 0.8, 0.6}, {1, 1, 2}), bonding, rock(), joint)}));
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
    const auto draw = [&](std::uint64_t k) { return geom::uniform(9, i, k) - 0.5; };
    s.state.velocity[i] = node(Vec3(0.3, -0.2, 0.1) + 0.02 * Vec3(draw(0), draw(1), draw(2)) +
                               Vec3(1, 2, 3).cross(s.model.node_position[i]));
  }
  const Momentum before = momentum(s, Places::present);
  const auto linear_drift = [&] {
    return (momentum(s, Places::present).linear - before.linear).norm() / before.linear.norm();
  };
  const auto angular_drift = [&] {
    return (momentum(s, Places::present).angular - before.angular).norm() / before.angular.norm();
  };
  cdem::RunOptions options;
  options.breaking = breaking;
  options.follows_fragments = false; // momentum is kept however wrong the contact of the pieces is
  options.steps = 20000;
  s.run(options);
  CHECK((s.log.broken_tension + s.log.broken_shear > 0) == breaking);
  // The forces of a contact act on its two points, which part as the faces slide: their distance is an arm.
  // Intact bonds with Ks = Kn pull along it and have none.
  CHECK(angular_drift() < (breaking ? 1e-6 : 1e-12));
  options.steps = 80000;
  s.run(options);
  CHECK(linear_drift() < 1e-12);
  if (!breaking)
    CHECK(angular_drift() < 1e-12);
}
