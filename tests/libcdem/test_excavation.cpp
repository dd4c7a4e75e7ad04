// Blocks taken out and bonds undone on the way.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

geom::Box box(double x0, double x1, double z0 = -10, double z1 = 10) {
  return {{x0, -10, z0}, {x1, 10, z1}};
}

} // namespace

TEST_CASE("a column whose upper part is taken away carries what is left", "[excavation]") {
  cdem::Simulation s = simulation(geom::grid({0.1, 0.1, 0.5}, {1, 1, 5}));
  s.fix(fixed(cdem::Selection::side("z-")));
  s.gravity(gravity());
  REQUIRE(s.relax({}).converged);
  const double weight = rock().density * 9.81 * 1e-3; // N, of one block
  CHECK(s.reaction(cdem::Selection::side("z-")).z() == Approx(5 * weight).epsilon(1e-4));
  const std::int64_t bonds = s.counts().bonds;
  CHECK(s.remove(cdem::Selection::in_box(box(-1, 1, 0.3, 1))) == 2);
  CHECK(s.counts().blocks == 3);
  CHECK(s.counts().interfaces == 2);
  CHECK(s.counts().bonds == bonds / 2);
  REQUIRE(s.relax({}).converged);
  CHECK(s.reaction(cdem::Selection::side("z-")).z() == Approx(3 * weight).epsilon(1e-4));
}

TEST_CASE("a condition whose whole place is removed acts on nothing from then on", "[excavation]") {
  cdem::Simulation s = simulation(geom::grid({0.3, 0.1, 0.2}, {3, 1, 2}));
  const cdem::Selection end = cdem::Selection::in_box(box(0.299, 0.301));
  s.fix(fixed(cdem::Selection::side("x-")));
  s.fix(fixed(end));
  s.traction(traction(end, {0, 0, -1e4}));
  s.force({end, {0, 0, -10}, {}});
  s.gravity(gravity());
  if (GENERATE(false, true))
    s.release(end, axes("xyz"));
  REQUIRE(s.relax({}).converged);
  REQUIRE(s.remove(cdem::Selection::in_box(box(0.2, 0.4))) == 2);
  REQUIRE(s.relax({}).converged);
  CHECK(s.reaction(cdem::Selection::side("x-")).z() ==
        Approx(4 * rock().density * 9.81 * 1e-3).epsilon(1e-3));
  CHECK(s.fragments().size() == 1);
  CHECK_THROWS_WITH(s.fix(fixed(end)), Catch::Contains("holds nodes")); // a new one is refused
  CHECK_THROWS_WITH(s.traction(traction(end, {0, 0, -1e4})), Catch::Contains("outer faces"));
}

TEST_CASE("a condition on a side never goes over to the face that an excavation leaves", "[excavation]") {
  cdem::Joint dry = rock_joint();
  dry.bonded = false;
  const double weight = rock().density * 9.81 * 4; // N, of one block
  cdem::Simulation s = simulation(geom::grid({2, 2, 3}, {1, 1, 3}), rock(), dry);
  s.gravity(gravity());
  SECTION("a support") {
    s.fix(fixed(cdem::Selection::side("z-")));
    s.fix(fixed(cdem::Selection::side("z+")));
    REQUIRE(s.relax({}).converged);
    REQUIRE(s.remove(cdem::Selection::in_box(box(-1, 3, -1, 1))) == 1);
    cdem::RunOptions options;
    options.duration = 0.01;
    s.run(options); // the middle block hung on nothing but what stood below it
    CHECK(s.at("velocity.z", {1, 1, 1.5}) == Approx(-9.81 * 0.01).epsilon(0.02));
    CHECK_THROWS_WITH(s.reaction(cdem::Selection::side("z-")), Catch::Contains("holds nodes"));
  }
  SECTION("a load") {
    const cdem::Selection foot = cdem::Selection::side("z-"), top = cdem::Selection::side("z+");
    s.fix(fixed(foot));
    s.traction(traction(top, {0, 0, -1e6}));
    REQUIRE(s.relax({}).converged);
    REQUIRE(s.remove(cdem::Selection::in_box(box(-1, 3, 2, 4))) == 1);
    REQUIRE(s.relax({}).converged);
    CHECK(s.reaction(foot).z() == Approx(2 * weight).epsilon(1e-3));
  }
}

TEST_CASE("units keep their numbers when others are taken out", "[excavation]") {
  cdem::Simulation s = simulation(geom::grid({0.4, 0.1, 0.1}, {4, 1, 1}));
  const auto unit = [&](int number) { return cdem::Selection::of_units(s.model().bodies[0].name, {number}); };
  const cdem::Selection first = unit(1), third = unit(3);
  s.fix(fixed(unit(2)));
  s.fix(fixed(first));
  REQUIRE(s.remove(first) == 1);
  CHECK(cdem::selected_nodes(s.model(), first).empty());
  for (const int node : cdem::selected_nodes(s.model(), third)) {
    CHECK(s.model().node_position[node].x() > 0.2 - 1e-9);
    CHECK(s.model().node_position[node].x() < 0.3 + 1e-9);
  }
  s.gravity(gravity());
  REQUIRE(s.relax({}).converged);
  CHECK(s.at("displacement.magnitude", {0.15, 0.05, 0.05}) == 0); // unit 2 is held
  CHECK(s.at("displacement.magnitude", {0.25, 0.05, 0.05}) > 0);
  CHECK_THROWS_WITH(cdem::selected_nodes(s.model(), unit(5)), Catch::Contains("which has 4"));
}

TEST_CASE("a chamber cut out of stressed rock closes in on itself and stays in balance", "[excavation]") {
  cdem::Joint joint = rock_joint();
  cdem::Simulation s = simulation(geom::grid({0.7, 0.1, 0.7}, {7, 1, 7}, {-0.35, 0, -0.35}), rock(), joint);
  s.initial_stress(cdem::Selection::everything(), {-2e6, 0, -2e6, 0, 0, 0});
  for (const char* side : {"x-", "x+"})
    s.fix(fixed(cdem::Selection::side(side), "x"));
  for (const char* side : {"z-", "z+"})
    s.fix(fixed(cdem::Selection::side(side), "z"));
  s.fix(fixed(cdem::Selection::side("y-"), "y"));
  s.fix(fixed(cdem::Selection::side("y+"), "y"));
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  CHECK(s.max("displacement.magnitude").value < 1e-12);
  CHECK(s.remove(cdem::Selection::in_box({{-0.06, -1, -0.06}, {0.06, 1, 0.06}})) == 1);
  REQUIRE(s.relax(options).converged);
  // The four walls move inwards by the same amount.
  const double left = s.at("displacement.x", {-0.051, 0.05, 0}),
               right = s.at("displacement.x", {0.051, 0.05, 0});
  const double below = s.at("displacement.z", {0, 0.05, -0.051}),
               above = s.at("displacement.z", {0, 0.05, 0.051});
  CHECK(left > 0.5 * 2e6 / rock().youngs_modulus * 0.05);
  CHECK(right == Approx(-left).epsilon(1e-5));
  CHECK(below == Approx(left).epsilon(1e-5));
  CHECK(above == Approx(-left).epsilon(1e-5));
  CHECK(s.reaction(cdem::Selection::side("x-")).x() ==
        Approx(-s.reaction(cdem::Selection::side("x+")).x()).epsilon(1e-5));
}

TEST_CASE("blocks that stay keep their state when others are taken out", "[excavation]") {
  cdem::Simulation s = simulation(geom::grid({0.4, 0.1, 0.1}, {4, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  s.traction(traction(cdem::Selection::side("x+"), {1e6, 0, 0}));
  cdem::RunOptions options;
  options.steps = 100;
  s.run(options);
  const auto before = s.blocks();
  s.clear_loads();
  s.remove(cdem::Selection::in_box(box(0.3, 0.4)));
  const auto after = s.blocks();
  REQUIRE(after.size() == 3);
  for (int b = 0; b < 3; ++b) {
    CHECK(after[b].id == before[b].id);
    CHECK(after[b].displacement == before[b].displacement);
    CHECK(after[b].stress == before[b].stress);
  }
  CHECK(s.steps() == 100);
}

TEST_CASE("an unbonded section carries pressure and no tension", "[excavation]") {
  cdem::Simulation s = simulation(geom::grid({0.4, 0.1, 0.1}, {4, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  const auto move_end = [&](double displacement) {
    cdem::Fix pull = fixed(cdem::Selection::side("x+"));
    pull.displacement = Vec3(displacement, 0, 0);
    s.fix(pull);
    REQUIRE(s.relax({}).converged);
    return s.reaction(cdem::Selection::side("x+")).x();
  };
  const double bonded = move_end(1e-6);
  CHECK(bonded > 0);
  const std::int64_t bonds = s.counts().bonds;
  CHECK(s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0.2, 0, 0}, {1, 0, 0}))) == bonds / 3);
  CHECK(s.counts().contacts == bonds / 3);
  CHECK(s.counts().intact == bonds - bonds / 3);
  CHECK(std::abs(move_end(1e-6)) < 1e-6 * bonded);
  CHECK(move_end(-1e-6) == Approx(-bonded).epsilon(1e-5));
}
