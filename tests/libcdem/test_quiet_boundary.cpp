// Quiet boundaries and free fields: waves that leave do not come back, a wave that enters is the one asked for, and a
// plane wave passes along a free field unspoiled.
#include "libcdem/load/quiet.hpp"
#include "libcdem/material/wave_speeds.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/step/support_forces.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/going_on.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double height = 4, width = 0.2, wave_length = 2; // m

// What moves along: 2 z, a P wave; 0 x, an S wave.
double speed_of(int axis) {
  return axis == 2 ? cdem::dilatational_speed(rock()) : cdem::shear_speed(rock());
}

// A pulse of velocity 1 m/s that lasts T, smooth at both ends.
cdem::Amplitude pulse(double duration) {
  return [duration](double t) { return t < duration ? 0.5 - 0.5 * std::cos(2 * pi * t / duration) : 0; };
}

geom::TetMesh column_mesh(int divisions, double jitter = 0) {
  return geom::box_mesh({width, width, height}, {2, 2, divisions}, jitter);
}

// One dimension: nothing but the wave's direction moves.
void hold_across(System& s, int axis) {
  s.hold(cdem::Selection::everything(), axis == 2 ? "xy" : axis == 0 ? "yz" : "xz");
}

double mean_velocity(const System& s, int axis, double z, double within) {
  double sum = 0, mass = 0;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (std::abs(s.model.node_position[i].z() - z) < within) {
      sum += s.model.node_mass[i] * vec(s.state.velocity[i])[axis];
      mass += s.model.node_mass[i];
    }
  return sum / mass;
}

// A wave enters at the foot and leaves at the top. Amplitude that comes back past the middle, over that which went by.
double comes_back(System s, int axis) {
  hold_across(s, axis);
  const double duration = wave_length / speed_of(axis), crossing = height / speed_of(axis);
  cdem::Quiet foot;
  foot.on = cdem::Selection::side("z-");
  foot.velocity = Vec3::Unit(axis);
  foot.amplitude = pulse(duration);
  s.conditions.quiets = {foot, {cdem::Selection::side("z+"), Vec3::Zero(), Vec3::Zero(), {}}};
  double went = 0, back = 0;
  cdem::RunOptions options;
  options.breaking = false;
  options.duration = 2 * crossing;
  options.callback_every = 1;
  options.callback = [&] {
    const double v = std::abs(mean_velocity(s, axis, 0.5 * height, 0.06));
    // The pulse has passed the middle by half a crossing and its own length.
    double& most = s.state.time < 0.55 * crossing + duration ? went : back;
    most = std::max(most, v);
  };
  s.run(options);
  CHECK(went == Approx(1).epsilon(0.02));
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  CHECK(e.balance_error() < 1e-3);
  CHECK(e.radiated > 0.99 * e.external); // all of it has left
  return back / went;
}

} // namespace

TEST_CASE("a quiet boundary: less than 1 % of a P or S wave at normal incidence comes back",
          "[quiet][mesh]") {
  const int axis = GENERATE(2, 0);
  INFO((axis == 2 ? "P wave" : "S wave"));
  SECTION("structured meshes") {
    const int divisions = GENERATE(40, 60);
    CHECK(comes_back(System(build({meshed("column", column_mesh(divisions))})), axis) < 0.01);
  }
  SECTION("an unstructured mesh") {
    CHECK(comes_back(System(build({meshed("column", column_mesh(50, 0.15))})), axis) < 0.01);
  }
}

TEST_CASE("a quiet boundary of blocks with stiff joints", "[quiet]") {
  cdem::Joint joint = rock_joint();
  joint.thickness_ratio = 0.001;
  const int axis = GENERATE(2, 0);
  const auto column = [&](cdem::Element element, int blocks) {
    cdem::BodySpec spec = body("column", geom::grid({0.1, 0.1, height}, {1, 1, blocks}), rock(), joint);
    spec.element = element;
    return System(build({spec}));
  };
  SECTION("small strain") {
    CHECK(comes_back(column(cdem::Element::small_strain, 40), axis) < 0.01);
  }
  SECTION("finite volume: more of the mass is in the middle of a block, so a wave needs more blocks") {
    CHECK(comes_back(column(cdem::Element::finite_volume, 80), axis) < 0.01);
    CHECK(comes_back(column(cdem::Element::finite_volume, 40), axis) < 0.02);
  }
}

TEST_CASE("a stress wave of rho c v enters as the velocity v does", "[quiet][mesh]") {
  const auto run = [](bool stress) {
    System s(build({meshed("column", column_mesh(30))}));
    hold_across(s, 0);
    cdem::Quiet foot;
    foot.on = cdem::Selection::side("z-");
    (stress ? foot.stress : foot.velocity) =
        (stress ? rock().density * cdem::shear_speed(rock()) : 1) * Vec3::UnitX();
    foot.amplitude = pulse(wave_length / cdem::shear_speed(rock()));
    s.conditions.quiets = {foot};
    cdem::RunOptions options;
    options.duration = (height + 0.5 * wave_length) / cdem::shear_speed(rock());
    s.run(options);
    return mean_velocity(s, 0, height, 1e-6);
  };
  const double v = run(false);
  CHECK(std::abs(v) > 0.1); // the free top moves
  CHECK(run(true) == Approx(v).epsilon(1e-9));
}

TEST_CASE("a free field: a plane wave rises beside it as in an endless layer", "[quiet][mesh]") {
  const int axis = GENERATE(0, 2);
  const double long_side = 2, tall = 2, speed = speed_of(axis), duration = tall / speed;
  const auto surface_motion = [&](bool free_field, bool one_dimension) {
    System s(build({meshed("layer", geom::box_mesh({long_side, 0.4, tall}, {20, 4, 20}))}));
    cdem::Quiet foot;
    foot.on = cdem::Selection::side("z-");
    foot.velocity = Vec3::Unit(axis);
    foot.amplitude = pulse(duration);
    s.conditions.quiets = {foot};
    if (one_dimension)
      hold_across(s, axis);
    else
      s.hold(cdem::Selection::side("y-"), "y"), s.hold(cdem::Selection::side("y+"), "y");
    if (free_field)
      for (const char* side : {"x-", "x+"})
        s.conditions.free_fields.push_back({cdem::Selection::side(side)});
    s.state.column_displacement.resize(42 * (free_field ? 1 : 0));
    s.state.column_velocity.resize(s.state.column_displacement.size());
    std::vector<double> motion;
    cdem::RunOptions options;
    options.time_step = 0.5 * cdem::stable_time_step(s.model);
    options.duration = 3 * tall / speed;
    options.callback_every = 2;
    options.callback = [&] {
      double sum = 0, count = 0; // the middle of the free surface, and its corners
      for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
        if (s.model.node_position[i].z() > tall - 1e-6) {
          sum += vec(s.state.velocity[i])[axis];
          ++count;
        }
      motion.push_back(sum / count);
    };
    s.run(options);
    if (free_field)
      CHECK(cdem::energy(s.model, s.state).balance_error() < 2e-3);
    return motion;
  };
  const std::vector<double> reference = surface_motion(false, true), with = surface_motion(true, false),
                            without = surface_motion(false, false);
  double most = 0, off = 0, off_without = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    most = std::max(most, std::abs(reference[i]));
    off = std::max(off, std::abs(with[i] - reference[i]));
    off_without = std::max(off_without, std::abs(without[i] - reference[i]));
  }
  CHECK(most == Approx(2).epsilon(0.02)); // a free surface doubles the wave
  CHECK(off < 0.02 * most);
  if (axis == 2) // sides that are free bulge under a P wave
    CHECK(off_without > 5 * off);
}

namespace {

const cdem::Selection foot = cdem::Selection::side("z-");

cdem::Simulation layer(int threads, std::shared_ptr<cdem::Observer> observer) {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("layer", geom::box_mesh({0.4, 0.4, 0.4}, {4, 4, 4}))};
  return cdem::Simulation(spec, threads, std::move(observer));
}

void stand_under_weight(cdem::Simulation& s, bool solve) {
  s.fix(fixed(foot));
  for (const char* side : {"x-", "x+"})
    s.fix(fixed(cdem::Selection::side(side), "x"));
  s.gravity(gravity());
  cdem::RelaxOptions relax;
  relax.residual = 1e-10;
  if (solve)
    s.relax(relax);
}

} // namespace

TEST_CASE("quiet boundaries and free fields take the place of supports without a jolt", "[quiet]") {
  cdem::Simulation s = layer(1, nullptr);
  stand_under_weight(s, true);
  const Vec3 expected = s.reaction(foot), held = s.reaction(cdem::Selection::side("x-"));
  s.quiet({foot, Vec3::Zero(), Vec3::Zero(), {}});
  for (const char* side : {"x-", "x+"})
    s.free_field({cdem::Selection::side(side)});
  CHECK_THROWS_WITH(s.relax({}), Catch::Matchers::Contains("find the static balance with model:fix"));
  cdem::RunOptions run;
  run.steps = 500;
  const Vec3 weight = s.reaction(foot), thrust = s.reaction(cdem::Selection::side("x-"));
  CHECK(weight.z() == Approx(expected.z()).epsilon(1e-6));
  CHECK(thrust.x() == Approx(held.x()).epsilon(1e-6));
  s.run(run);
  CHECK(s.max("velocity.magnitude").value < 1e-8);
  CHECK(s.reaction(foot).z() == Approx(expected.z()).epsilon(1e-6));
  CHECK(s.reaction(cdem::Selection::side("x-")).x() == Approx(held.x()).epsilon(1e-6));
}

TEST_CASE("the reaction of a quiet boundary is the traction of the waves there", "[quiet][mesh]") {
  // A P wave of velocity v that enters at the foot and leaves at the top presses on both with rho c v A; the foot feels the
  // model's side of it: the wave that it sends in.
  System s(build({meshed("column", column_mesh(80))}));
  hold_across(s, 2);
  const double speed = speed_of(2), duration = wave_length / speed;
  cdem::Quiet bottom;
  bottom.on = cdem::Selection::side("z-");
  bottom.velocity = Vec3::UnitZ();
  bottom.amplitude = pulse(duration);
  s.conditions.quiets = {bottom, {cdem::Selection::side("z+"), Vec3::Zero(), Vec3::Zero(), {}}};
  double at_foot = 0, at_top = 0;
  cdem::RunOptions options;
  options.breaking = false;
  options.duration = 2 * height / speed;
  options.callback_every = 5;
  options.callback = [&] {
    const cdem::SupportForces forces(s.model, s.state, s.conditions, 1);
    at_foot = std::max(at_foot, forces.reaction(bottom.on).z());
    at_top = std::min(at_top, forces.reaction(cdem::Selection::side("z+")).z());
  };
  s.run(options);
  const double wave = rock().density * speed * width * width;
  CHECK(at_foot == Approx(wave).epsilon(0.02));
  CHECK(at_top == Approx(-wave).epsilon(0.02));
}

TEST_CASE("a run with a wave through a quiet boundary and free fields goes on to the same bits",
          "[quiet][checkpoint]") {
  const auto solve = [&](cdem::Simulation& s, int done) {
    stand_under_weight(s, done < 1);
    s.set_replaying(done > 0); // what the boundaries took over is in the state that was restored
    cdem::Quiet quiet;
    quiet.on = foot;
    quiet.velocity = {0.01, 0, 0};
    quiet.amplitude = pulse(1e-3);
    s.quiet(quiet);
    for (const char* side : {"x-", "x+"})
      s.free_field({cdem::Selection::side(side)});
    s.set_replaying(false);
    cdem::RunOptions run;
    run.steps = 1000;
    s.run(run);
    return Figures{s.max("velocity.x").value, s.energy().radiated};
  };
  check_going_on(layer, solve, {20, 60});
}

TEST_CASE("what a quiet boundary and a free field refuse", "[quiet]") {
  cdem::Simulation s = layer(1, nullptr);
  CHECK_THROWS_WITH(s.free_field({cdem::Selection::side("z+")}),
                    Catch::Matchers::Contains("a free field stands at a vertical side"));
  CHECK_THROWS_WITH(s.free_field({cdem::Selection::side("x+")}), Catch::Matchers::Contains("no foot"));
}
