// Froude and Cauchy similarity: a model k^2 times as large, of the same density and under the same gravity, whose
// material is k^2 times as stiff and as strong, moves in the same way k times as slowly:
//
//     lengths k^2, times k, velocities k, stresses k^2, forces k^6, energies k^8
//
// For k = 2 and 1/2 all factors are powers of two and the same bits come out. A length, a time or a stress that stood in
// the code and not in the model would break that, chaotic as piles are.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

struct Scale {
  double time, length = time * time, velocity = time, stress = length, energy = std::pow(time, 8);

  geom::TetMesh box(const Vec3& size, const std::array<int, 3>& divisions, const Vec3& corner,
                    double angle = 0) const {
    geom::TetMesh mesh = geom::box_mesh(length * size, divisions);
    const geom::Mat3 turn = rotation(Vec3(1, 2, 3).normalized(), angle);
    for (Vec3& x : mesh.nodes)
      x = turn * x + length * corner;
    return mesh;
  }
  cdem::Elastic concrete() const {
    cdem::Elastic m = rock();
    m.youngs_modulus = 3e8 * stress; // large steps
    m.stiffness_damping = 1e-4 * time;
    return m;
  }
  cdem::Joint joint(bool bonded) const {
    cdem::Joint j;
    j.bonded = bonded;
    j.friction_angle = 35 * degree;
    j.cohesion = 8e3 * stress;
    j.tensile_strength = 5e3 * stress;
    return j;
  }
};

struct Story {
  Scale of;
  cdem::Simulation model;
  std::vector<cdem::Departure> left = {};
};

void check_same_story(const Story& a, const Story& b) {
  const double k = b.of.time / a.of.time, length = k * k, stress = length, energy = std::pow(k, 8);
  CHECK(b.model.steps() == a.model.steps());
  CHECK(b.model.time() == k * a.model.time());
  const auto was = a.model.blocks(), is = b.model.blocks();
  REQUIRE(is.size() == was.size());
  int different = 0;
  for (std::size_t i = 0; i < is.size(); ++i) {
    different += is[i].displacement != length * was[i].displacement;
    for (int c = 0; c < 6; ++c)
      different += is[i].stress[c] != stress * was[i].stress[c];
  }
  CHECK(different == 0);
  REQUIRE(b.model.log().breaks.size() == a.model.log().breaks.size());
  for (std::size_t i = 0; i < b.model.log().breaks.size(); ++i) {
    const cdem::BreakRow &then = a.model.log().breaks[i], &now = b.model.log().breaks[i];
    different += now.step != then.step || now.mode != then.mode || now.place != length * then.place ||
                 now.normal_traction != stress * then.normal_traction;
  }
  CHECK(different == 0);
  const cdem::EnergyLedger then = a.model.energy(), now = b.model.energy();
  CHECK(now.elastic == energy * then.elastic);
  CHECK(now.springs == energy * then.springs);
  CHECK(now.kinetic == energy * then.kinetic);
  CHECK(now.damping == energy * then.damping);
  CHECK(now.friction == energy * then.friction);
  CHECK(now.breaking == energy * then.breaking);
  CHECK(now.external == energy * then.external);
  REQUIRE(b.left.size() == a.left.size());
  for (std::size_t i = 0; i < b.left.size(); ++i) {
    CHECK(b.left[i].unit == a.left[i].unit);
    CHECK(b.left[i].step == a.left[i].step);
    CHECK(b.left[i].velocity == k * a.left[i].velocity);
    CHECK(b.left[i].displacement == length * a.left[i].displacement);
  }
  CHECK(b.model.contacts().acting == a.model.contacts().acting);
  CHECK(b.model.contacts().deepest == length * a.model.contacts().deepest);
}

// A bonded bar thrown at a tilted rigid floor breaks in pieces that meet each other.
Story bar_thrown(double k) {
  const Scale of{k};
  cdem::Bonding bonding;
  bonding.everywhere = true;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", of.box({2, 2, 0.4}, {4, 4, 1}, {-1, -1, -0.4}), {}, of.concrete()),
                 meshed("bar", of.box({0.9, 0.3, 0.3}, {3, 1, 1}, {-0.4, -0.3, 0.4}, 0.5), bonding,
                        of.concrete(), of.joint(true))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.pairs = {{"floor", "bar", of.joint(false)}, {"bar", "bar", of.joint(false)}};
  Story story{of, cdem::Simulation(spec, 1, nullptr)};
  story.model.fix(fixed(cdem::Selection::of_body("floor")));
  story.model.gravity(gravity({2, 0, -9.81}));
  story.model.initial_velocity(cdem::Selection::of_body("bar"), of.velocity * Vec3(1, 0.5, -3));
  cdem::RunOptions run;
  run.duration = 0.1 * of.time;
  story.model.run(run);
  return story;
}

// Cubes settle on a slope, rigid at first, and a flow that rises takes one after the other.
Story cubes_in_a_flow(double k) {
  const Scale of{k};
  cdem::ModelSpec spec;
  const auto unit = [&](int i) {
    const bool odd = i % 2 == 1;
    return of.box({0.5, 0.5, 0.5}, {2, 2, 2}, {0.5 * i - 0.8, odd ? 0.1 : 0.0, odd ? 1.1 : 0.2}, 0.3 * i);
  };
  spec.bodies = {meshed("floor", of.box({6, 3, 0.5}, {12, 6, 1}, {-3, -1.5, -0.5}), {}, of.concrete()),
                 meshed("units", unit(0), {}, of.concrete())};
  for (int i = 1; i < 4; ++i)
    spec.bodies[1].meshes.push_back(unit(i));
  spec.bodies[0].element = cdem::Element::rigid;
  spec.pairs = {{"floor", "units", of.joint(false)}, {"units", "units", of.joint(false)}};
  Story story{of, cdem::Simulation(spec, 1, nullptr)};
  story.model.fix(fixed(cdem::Selection::of_body("floor")));
  cdem::Gravity weight = gravity({-2, 0, -9.81});
  weight.water_density = 1025;
  story.model.gravity(weight);
  cdem::SettleOptions settle;
  settle.kinetic_energy_ratio = 1e-4;
  settle.max_time = 20 * of.time;
  settle.friction_angle = 30 * degree;
  REQUIRE(story.model.settle(settle).converged);
  const std::size_t watch = story.model.watch("units", 0.25 * of.length);
  cdem::Flow flow;
  flow.on = {cdem::Selection::of_body("units")};
  flow.direction = {1, 0, 0.1};
  flow.water_density = 1025;
  const double since = story.model.time();
  flow.velocity = [=](double time) { return 3 * of.velocity + 3 * std::max(0.0, time - since); };
  story.model.flow(flow);
  cdem::RunOptions run;
  run.duration = 1 * of.time;
  story.model.run(run);
  story.left = story.model.log().watches.at(watch).left;
  return story;
}

// A plate of small-strain blocks is pressed until some are cut along their failure planes and bonds break.
Story plate_cut(double k) {
  const Scale of{k};
  cdem::ModelSpec spec;
  spec.bodies = {
      body("plate", geom::grid(of.length * Vec3(0.4, 0.8, 0.1), {4, 8, 1}), of.concrete(), of.joint(true))};
  Story story{of, cdem::Simulation(spec, 1, nullptr)};
  story.model.fix(fixed(cdem::Selection::side("y-")));
  story.model.traction(traction(cdem::Selection::side("y+"), of.stress * Vec3(0, -2.6e4, 0)));
  cdem::RelaxOptions relax;
  relax.residual = 1e-4;
  relax.breaking = false;
  story.model.relax(relax);
  cdem::RefineOptions refine;
  refine.shear_threshold = 2e3 * of.stress;
  refine.tension_threshold = 1e3 * of.stress;
  CHECK_FALSE(story.model.refine(refine).empty());
  cdem::RunOptions run;
  run.steps = 400;
  story.model.run(run);
  return story;
}

} // namespace

TEST_CASE("similarity: a bar that breaks and whose pieces collide is the same motion at every scale",
          "[contact][face_bonds][similarity]") {
  const Story one = bar_thrown(1);
  CHECK(one.model.log().breaks.size() > 20);
  CHECK(one.model.energy().friction > 0);
  for (const double k : {2.0, 0.5}) {
    INFO("times " << k);
    check_same_story(one, bar_thrown(k));
  }
}

TEST_CASE("similarity: units that settle and leave in a flow do so alike at every scale",
          "[settle][flow][watch][similarity]") {
  const Story one = cubes_in_a_flow(1);
  CHECK(one.left.size() >= 2);
  for (const double k : {2.0, 0.5}) {
    INFO("times " << k);
    check_same_story(one, cubes_in_a_flow(k));
  }
}

TEST_CASE("similarity: blocks that are cut and break do so alike at every scale", "[refine][similarity]") {
  const Story one = plate_cut(1);
  CHECK(one.model.log().breaks.size() > 10);
  for (const double k : {2.0, 0.5}) {
    INFO("times " << k);
    check_same_story(one, plate_cut(k));
  }
}
