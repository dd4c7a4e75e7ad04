// Blocks that slide over a base which joints cut into blocks: those never end in exactly one plane, and the steps between
// them stop nothing.
#include "tests/libcdem/boxes.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using cdem::Verdict;
using geom::Vec3;

namespace {

constexpr double g = 9.81, steep = 30 * degree;

struct Joints {
  double above = 0, below = 0; // m, from joint to joint in the slab and in the base; 0: none
  double shift = 0;            // m, of those below
  double angle = 90;           // degrees, from the base to the joints
  double aside = 0;            // degrees, from the slip to the joints' dip
};

geom::Assembly cut(geom::Assembly shape, double first, double spacing, const Joints& joints) {
  const geom::Mat3 turn = rotation({0, 0, 1}, joints.aside * degree);
  const Vec3 normal = turn * Vec3(std::sin(joints.angle * degree), 0, -std::cos(joints.angle * degree));
  if (spacing > 0)
    for (double x = first; x < 12.5; x += spacing)
      shape = geom::cut_by_plane(shape, geom::Plane::through({x, 0.5, 0}, normal));
  return shape;
}

// A slab, 8 m long and 1 m thick, on a held base; gravity leans by `steep`.
cdem::Simulation slab_on(const Joints& joints, double friction_angle, bool rigid = false) {
  cdem::Elastic stone = soft_rock();
  stone.poissons_ratio = 0.2;
  const cdem::Joint strong = friction(80);
  cdem::ModelSpec spec;
  spec.bodies = {
      body("base",
           cut(geom::grid({16, 1, 1}, {1, 1, 1}, {-2, 0, -1}), -3 + joints.shift, joints.below, joints),
           stone, strong),
      body("slab", cut(geom::grid({8, 1, 1}, {1, 1, 1}), -3, joints.above, joints), stone, strong)};
  for (cdem::BodySpec& of : spec.bodies)
    of.element = rigid ? cdem::Element::rigid : cdem::Element::finite_volume;
  spec.pairs = {{"base", "slab", friction(friction_angle)}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(rigid ? fixed(cdem::Selection::of_body("base")) : fixed(cdem::Selection::side("z-")));
  for (const char* side : {"y-", "y+"})
    if (!rigid)
      s.fix(fixed(cdem::Selection::side(side), "y"));
  s.gravity(gravity(g * Vec3(std::sin(steep), 0, -std::cos(steep))));
  return s;
}

double slid(const cdem::Simulation& s) { // m, mean
  return s.mean("displacement.x",
                cdem::Selection::where([](const Vec3& x) { return x.z() > 1e-3; }, "the slab"));
}

cdem::RelaxResult relax(cdem::Simulation& s, std::int64_t max_steps = 20000) {
  cdem::RelaxOptions options;
  options.residual = 1e-4;
  options.max_steps = max_steps;
  options.stop_on_failure = true;
  return s.relax(options);
}

// The friction that holds the slab falls at once from 45 degrees to `angle`.
void weaken(cdem::Simulation& s, double angle) {
  REQUIRE(relax(s).verdict == Verdict::stable);
  s.reduce_strength(1 / std::tan(angle * degree), {true, false});
  s.reset_displacement();
}

} // namespace

TEST_CASE("jointed base: a slab slides at g (sin a - tan(phi) cos a), wherever joints cut it and its base",
          "[sliding][contact]") {
  const double angle = GENERATE(60.0, 90.0, 110.0, 120.0);
  const Joints joints =
      GENERATE(Joints{2, 0}, Joints{0, 2}, Joints{2, 2}, Joints{2, 2, -0.02}, Joints{2, 1.5, 0.05});
  const double aside = GENERATE(0.0, 30.0); // at 35 a chip falls off, as below
  cdem::Simulation s = slab_on({joints.above, joints.below, joints.shift, angle, aside}, 45);
  weaken(s, 25);
  cdem::RunOptions options;
  options.duration = 0.4;
  s.run(options);
  const double expected = 0.5 * g * (std::sin(steep) - std::cos(steep) * std::tan(25 * degree)) * 0.4 * 0.4;
  CAPTURE(angle, aside, joints.above, joints.below, joints.shift);
  CHECK(slid(s) == Approx(expected).epsilon(0.02));
}

TEST_CASE("jointed base: rigid blocks slide over it too", "[sliding][contact][rigid]") {
  const double angle = GENERATE(70.0, 90.0, 110.0);
  cdem::Simulation s = slab_on({2, 2, 0, angle}, 25, true);
  cdem::RunOptions options;
  options.duration = 0.4;
  s.run(options);
  const double expected = 0.5 * g * (std::sin(steep) - std::cos(steep) * std::tan(25 * degree)) * 0.4 * 0.4;
  CHECK(slid(s) == Approx(expected).epsilon(0.1)); // it hops at first: its weight comes all at once
}

TEST_CASE("jointed base: a relaxation finds that a slab slides, at the friction of the formula",
          "[sliding][contact][stability]") {
  const double angle = GENERATE(60.0, 70.0, 90.0, 110.0);
  const Joints joints = GENERATE(Joints{2, 0}, Joints{0, 2}, Joints{2, 2});
  CAPTURE(angle, joints.above, joints.below);
  for (const double over : {-0.03, 0.03}) { // of the tangent
    cdem::Simulation s = slab_on({joints.above, joints.below, 0, angle}, 45);
    weaken(s, std::atan((1 + over) * std::tan(steep)) / degree);
    CHECK(relax(s).verdict == (over > 0 ? Verdict::stable : Verdict::failing));
  }
}

TEST_CASE("jointed base: a slab goes on sliding in a relaxation past all depths at which contacts stand in",
          "[sliding][contact][stability]") {
  const double angle = GENERATE(60.0, 70.0, 90.0, 110.0);
  cdem::Simulation s = slab_on({2, 2, 0, angle}, 45);
  weaken(s, 28);
  cdem::RelaxOptions options;
  options.residual = 1e-4;
  options.max_steps = 8000;
  options.stop_on_failure = false;
  const cdem::RelaxResult r = s.relax(options);
  CHECK_FALSE(r.converged);
  CHECK(slid(s) > 0.02); // contacts stand in by 0.005 m
}

// The joint leaves it nothing to stand on: its weight passes beside the face that it leans on, which is 4 degrees from upright.
TEST_CASE("jointed base: a chip of 0.06 litres that a joint cuts off the toe of the slab falls",
          "[sliding][contact][stability]") {
  cdem::Simulation s = slab_on({2, 0, 0, 120, 35}, 45);
  const cdem::RelaxResult r = relax(s);
  CHECK(r.verdict == Verdict::failing);
  CHECK((r.moving_place - Vec3(8, 1, 1)).norm() < 0.1);
}
