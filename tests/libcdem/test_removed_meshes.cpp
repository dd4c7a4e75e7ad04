// Whole meshed bodies, and blocks beside meshes, are taken out of the model.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "tests/libcdem/boxes.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <string>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

geom::TetMesh with_top(geom::TetMesh mesh) {
  std::vector<int> top;
  const std::vector<geom::OuterFace> outer = geom::outer_faces(mesh);
  for (int f : geom::faces_towards(mesh, outer, {0, 0, 1}, 1 * degree))
    top.push_back(f);
  mesh.named["top"] = top;
  return mesh;
}

// Blocks and a cube on a plate.
cdem::Simulation table(cdem::Element plate) {
  cdem::ModelSpec spec;
  spec.bodies = {
      body("blocks", geom::grid({0.4, 0.4, 0.4}, {2, 1, 1}, {1, 0, 0.0001})),
      meshed("plate", placed(geom::box_mesh({2, 1, 0.2}, {4, 2, 1}), geom::Mat3::Identity(), {0, 0, -0.2})),
      meshed("cube", with_top(placed(geom::box_mesh({0.4, 0.4, 0.4}, {2, 2, 2}), geom::Mat3::Identity(),
                                     {0.2, 0.2, 0.0001})))};
  spec.bodies[0].element = cdem::Element::finite_volume;
  spec.bodies[1].element = plate;
  spec.default_contact = friction(30);
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(body_of("plate")));
  s.gravity(gravity());
  return s;
}

cdem::RunOptions for_time(double time) {
  cdem::RunOptions options;
  options.duration = time;
  return options;
}

} // namespace

TEST_CASE("what stood on a mesh that is removed falls freely, and the fix of it ends", "[carry]") {
  cdem::Simulation s = table(GENERATE(cdem::Element::rigid, cdem::Element::finite_volume));
  s.run(for_time(0.01));
  REQUIRE(s.contacts().deepest > 0); // they have met
  CHECK(s.remove(body_of("plate")) == 1);
  std::map<std::string, double> before;
  for (const char* name : {"blocks", "cube"})
    before[name] = s.mean("velocity.z", body_of(name));
  s.run(for_time(0.1));
  for (const char* name : {"blocks", "cube"})
    CHECK(s.mean("velocity.z", body_of(name)) == Approx(before[name] - 9.81 * 0.1).margin(0.02));
  CHECK(s.energy().balance_error() < 1e-3);
  CHECK_THAT(refusal([&] { s.fix(fixed(body_of("plate"))); }), Contains("has been removed"));
  s.fix(fixed(body_of("cube")));
}

TEST_CASE("named faces of a mesh stay its own where blocks before it are removed, and in what is saved then",
          "[carry]") {
  const cdem::Selection top = cdem::Selection::of_faces("top", "cube");
  cdem::Simulation s = table(cdem::Element::finite_volume);
  CHECK(s.remove(cdem::Selection::in_box({{1.2, -1, -1}, {2, 2, 2}})) == 1);
  s.initial_velocity(top, {0, 0, 3}, Vec3::Zero());
  cdem::Simulation again = table(cdem::Element::finite_volume);
  again.restore(s.save());
  for (const cdem::Simulation* of : {&s, &again}) {
    CHECK(of->mean("velocity.z", top) == Approx(3));
    CHECK(of->mean("velocity.z", cdem::Selection::in_box({{-1, -1, -1}, {3, 2, 0.3}})) == 0);
  }
}

TEST_CASE("a model that has lost its only plastic body is saved and comes back", "[carry][checkpoint]") {
  const auto build = [] {
    cdem::BodySpec soil =
        meshed("soil", placed(geom::box_mesh({1, 1, 1}, {2, 2, 2}), geom::Mat3::Identity(), {3, 0, 0}));
    cdem::Plasticity yields;
    yields.cohesion = 1e5;
    soil.plasticity.laws = {yields};
    soil.plasticity.others = 0;
    cdem::ModelSpec spec;
    spec.bodies = {meshed("rock", geom::box_mesh({1, 1, 1}, {2, 2, 2})), soil};
    spec.default_contact = friction(30);
    return cdem::Simulation(spec, 1, std::make_shared<cdem::Observer>());
  };
  cdem::Simulation s = build();
  s.gravity(gravity());
  CHECK(s.remove(body_of("soil")) == 1);
  s.run(for_time(0.001));
  cdem::Simulation again = build();
  again.restore(s.save());
  CHECK(again.state_hash() == s.state_hash());
}
