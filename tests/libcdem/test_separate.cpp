// Blocks may touch but not overlap.
#include "tests/libcdem/system.hpp"

#include "libcdem/contact/initial/separate.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

std::string refused(const cdem::ModelSpec& spec) {
  return refusal([&] { cdem::Simulation(spec, 1, nullptr); });
}

geom::Assembly bar() {
  return geom::grid({0.2, 0.1, 0.1}, {2, 1, 1});
}

} // namespace

TEST_CASE("blocks that occupy the same place are refused with their bodies and the place", "[separate]") {
  cdem::ModelSpec spec;
  spec.bodies = {body("one", bar()),
                 body("other", geom::grid({0.2, 0.1, 0.1}, {1, 1, 1}, {0.19, 0.09, 0.08}))};
  CHECK_THAT(refused(spec), Contains("\"one\" and \"other\"") && Contains("near (0.195, 0.095, 0.09) m"));
  geom::Assembly twice = bar();
  twice.blocks.push_back(twice.blocks[0]);
  spec.bodies = {body("one", twice)};
  CHECK_THAT(refused(spec), Contains("two blocks of body \"one\"") && Contains("near (0.05, 0.05, 0.05) m"));
  // Edge against edge, with boxes that overlap and no face between them: still apart.
  const double h = 0.1;
  geom::Assembly lower, upper;
  lower.blocks = {
      geom::convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, -1}, {1, 1, -1}, {0, -1, -1}, {1, -1, -1}})};
  upper.blocks = {geom::convex_hull(
      {{0.5, -0.5, -h}, {0.5, 0.5, -h}, {-0.5, -0.5, 1}, {-0.5, 0.5, 1}, {1.5, -0.5, 1}, {1.5, 0.5, 1}})};
  spec.bodies = {body("lower", lower), body("upper", upper)};
  CHECK_THAT(refused(spec), Contains("occupy the same place"));
  for (geom::Vec3& x : upper.blocks[0].vertices)
    x.z() += 1.001 * h;
  spec.bodies[1].shape = upper;
  CHECK(refused(spec).empty());
}

TEST_CASE("what the builders make is separate, turned and far from the origin as well", "[separate]") {
  geom::VoronoiOptions cells;
  cells.count = 200;
  cells.relaxations = 0;
  geom::BrickOptions wall;
  wall.size = {3, 0.5, 2};
  wall.brick = {0.7, 0.5, 0.3};
  const geom::JointSet steep{70 * degree, 20 * degree, 0.3, 0.2, 10 * degree, 10 * degree};
  const geom::JointSet flat{20 * degree, 200 * degree, 0.25, 0.2, 10 * degree, 10 * degree};
  const geom::Assembly shapes[] = {geom::voronoi(cells), geom::bricks(wall), geom::grid({1, 2, 3}, {3, 4, 5}),
                                   geom::cut_by_joints(geom::grid({1, 1, 1}, {2, 2, 2}), {steep, flat}, 3)};
  for (const geom::Assembly& shape : shapes) {
    CHECK_NOTHROW(cdem::require_separate(build({body("rock", shape)})));
    const geom::Assembly turned = geom::rotated(shape, {1, 2, 3}, 0.7);
    CHECK_NOTHROW(cdem::require_separate(build({body("rock", turned)})));
    CHECK_NOTHROW(cdem::require_separate(build({body("rock", geom::translated(turned, {5e4, -3e4, 1e4}))})));
  }
}
