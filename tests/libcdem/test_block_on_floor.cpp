// A block on a floor of another mesh: what a user sees of it. Restitution is the input between blocks as between meshes;
// a floor carries what stands on it, rigid or not; a vertex of a coarse floor carries as much as a few of the block's corners;
// rigid blocks in a stack keep their energy at the default time step; two copies of a body are refused.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double g = 9.81;

cdem::BodySpec box(const std::string& name, const Vec3& size, const Vec3& corner, cdem::Element element) {
  cdem::Elastic soft = rock();
  soft.youngs_modulus = 1e9;
  cdem::BodySpec spec = body(name, geom::grid(size, {1, 1, 1}, corner), soft);
  spec.element = element;
  return spec;
}

cdem::Joint floor_law(double restitution = 1) {
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 30 * degree;
  law.restitution = restitution;
  return law;
}

cdem::Simulation on_held_floor(std::vector<cdem::BodySpec> bodies, const cdem::Joint& law) {
  cdem::ModelSpec spec;
  spec.bodies = std::move(bodies);
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, nullptr);
  cdem::Fix floor;
  floor.on = cdem::Selection::of_body("floor");
  s.fix(floor);
  return s;
}

} // namespace

TEST_CASE("a block of one body rebounds from a block of another with the restitution of their contact",
          "[contact][moving]") {
  const cdem::Element element = GENERATE(cdem::Element::rigid, cdem::Element::finite_volume);
  const double restitution = GENERATE(0.3, 0.8);
  cdem::Joint law = floor_law(restitution);
  law.normal_stiffness = 2e7; // soft beside the block, E / 0.5 m = 2e9 Pa/m: waves keep next to nothing
  cdem::Simulation s = on_held_floor({box("floor", {3, 3, 1}, {-1.3, -1.2, -1}, element),
                                      box("block", {0.5, 0.5, 0.5}, {-0.25, -0.25, 0.01}, element)},
                                     law);
  s.initial_velocity(cdem::Selection::of_body("block"), {0, 0, -1}, Vec3::Zero());
  cdem::RunOptions options;
  options.duration = 0.1;
  options.safety = 0.2;
  s.run(options);
  CAPTURE(restitution);
  CHECK(s.mean("velocity.z", cdem::Selection::of_body("block")) == Approx(restitution).margin(0.02));
}

// A stage knows its contacts already; after it they are searched for.
TEST_CASE("the reaction that is read in a run is that of the same state after it", "[supports]") {
  const cdem::Element floor = GENERATE(cdem::Element::rigid, cdem::Element::finite_volume),
                      block = GENERATE(cdem::Element::rigid, cdem::Element::finite_volume);
  cdem::Simulation s = on_held_floor(
      {box("floor", {3, 3, 1}, {-1.3, -1.2, -1}, floor), box("block", {1, 1, 1}, {0, 0, 0}, block)},
      floor_law(0.5));
  s.gravity(gravity({3, 0, -9.81}));
  const cdem::Selection foot = cdem::Selection::of_body("floor");
  Vec3 read = Vec3::Zero();
  cdem::RunOptions options;
  options.duration = 2e-3;
  options.callback_every = 1;
  options.callback = [&] { read = s.reaction(foot); };
  s.run(options);
  const double weight = rock().density * g;
  CHECK(read.z() > 0.1 * weight);
  CHECK((read - s.reaction(foot)).norm() < 1e-9 * weight);
}

TEST_CASE("the reaction of a floor is its weight and that of what stands on it", "[supports]") {
  const cdem::Element floor = GENERATE(cdem::Element::rigid, cdem::Element::finite_volume);
  const bool by_its_foot = GENERATE(false, true);
  cdem::ModelSpec spec;
  spec.bodies = {box("floor", {3, 3, 1}, {-1, -1, -1}, floor),
                 box("block", {1, 1, 1}, {0, 0, 0}, cdem::Element::finite_volume)};
  spec.default_contact = floor_law();
  cdem::Simulation s(spec, 1, nullptr);
  const cdem::Selection foot = by_its_foot ? cdem::Selection::side("z-") : cdem::Selection::of_body("floor");
  s.fix(fixed(foot));
  s.gravity(gravity());
  cdem::RelaxOptions options;
  options.residual = 1e-6;
  s.relax(options);
  const Vec3 weight = s.reaction(foot);
  CHECK(weight.z() == Approx(10 * rock().density * g).epsilon(1e-5));
}

TEST_CASE("a vertex in the middle of a coarse floor is no spring of the whole floor", "[contact][moving]") {
  const cdem::Element element = GENERATE(cdem::Element::rigid, cdem::Element::finite_volume);
  const double width = 30;
  cdem::Simulation s = on_held_floor(
      {box("floor", {width, width, 1}, {-width / 2, -width / 2, -1}, cdem::Element::finite_volume),
       box("block", {1, 1, 1}, {-0.5, -0.5, 0.05}, element)},
      floor_law());
  s.gravity(gravity());
  cdem::RunOptions options;
  options.duration = 0.4;
  options.safety = 0.3;
  s.run(options);
  // It falls 0.05 m, and comes no higher than that again.
  const double fallen = rock().density * g * 0.05;
  CHECK(s.energy().kinetic < 1.05 * fallen);
  CHECK(s.energy().balance_error() < 0.02);
}

TEST_CASE("rigid blocks stacked on interfaces keep their energy at the default time step", "[moving]") {
  std::vector<cdem::BodySpec> bodies{box("floor", {3, 3, 1}, {-1, -1, -1}, cdem::Element::rigid)};
  for (int i = 0; i < 10; ++i)
    bodies.push_back(box("slab " + std::to_string(i), {1, 1, 0.1}, {0, 0, 0.1 * i}, cdem::Element::rigid));
  cdem::Simulation s = on_held_floor(std::move(bodies), floor_law());
  s.gravity(gravity());
  cdem::RunOptions options;
  options.duration = 0.2;
  s.run(options);
  // They sink by micrometres: next to no energy, and none of it made.
  CHECK(s.energy().balance_error() < 0.05);
  CHECK(s.energy().kinetic < 1e-3 * rock().density * g * 0.1);
}

TEST_CASE("two copies of a mesh, and one pushed into the other along a face, are refused", "[contact]") {
  const double up = GENERATE(0.0, 0.5, 0.9, 0.98, 0.995, 1.0);
  cdem::ModelSpec spec;
  geom::TetMesh lower = geom::box_mesh({1, 1, 1}, {2, 2, 2}), upper = lower;
  for (Vec3& x : upper.nodes)
    x.z() += up;
  spec.bodies = {meshed("lower", lower), meshed("upper", upper)};
  spec.default_contact = floor_law();
  CAPTURE(up);
  if (up < 0.99) // a hundredth of its size may be shared, as by units of a pile at rest
    CHECK_THROWS_AS(cdem::Simulation(spec, 1, nullptr), geom::InputError);
  else
    CHECK_NOTHROW(cdem::Simulation(spec, 1, nullptr));
}
