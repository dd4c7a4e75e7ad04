// A block on a fixed base, held by friction alone (a joint with bonded = false). The slide is short: springs
// stay with their points.
#include "tests/libcdem/system.hpp"

#include "libcdem/bond/contact_damping.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double earth_gravity = 9.81, phi = 30 * degree;

struct Slope {
  double size; // m, edge of the flat block that slides
  // The law is that of a rigid block: the contact's period is 20 times the block's own. An undamped elastic
  // block on a joint as stiff as itself chatters while it slides.
  bool rigid = false;

  System operator()(double steepness) const {
    cdem::Joint contact;
    contact.bonded = false;
    contact.friction_angle = phi;
    if (rigid) {
      const double own_period = 2 * size / std::sqrt(rock().youngs_modulus / rock().density);
      contact.normal_stiffness = rock().density * 0.1 * size * std::pow(2 * pi / (20 * own_period), 2);
      contact.shear_stiffness = *contact.normal_stiffness;
    }
    System s(build({body("base", geom::grid({1.4 * size, 0.5 * size, 0.1 * size}, {1, 1, 1},
                                            {-0.2 * size, 0, -0.1 * size})),
                    body("slider", geom::grid({size, 0.5 * size, 0.1 * size}, {2, 1, 1}))},
                   {{"base", "slider", contact}}));
    s.hold(cdem::Selection::of_body("base"), "xyz");
    tilt(s, steepness);
    return s;
  }

  static void tilt(System& s, double steepness) {
    s.conditions.gravity = cdem::Gravity{};
    s.conditions.gravity->acceleration = earth_gravity * Vec3(std::sin(steepness), 0, -std::cos(steepness));
  }
};

double slider_velocity(const System& s) {
  double momentum = 0, mass = 0;
  for (int i = 0; i < static_cast<int>(s.model.node_position.size()); ++i)
    if (s.model.blocks[block_of(s.model, i)].body == 1) {
      momentum += s.model.node_mass[i] * s.state.velocity[i].x;
      mass += s.model.node_mass[i];
    }
  return momentum / mass;
}

} // namespace

TEST_CASE("a block slides down an incline with g (sin a - tan phi cos a)", "[friction]") {
  const Slope slope{GENERATE(1.0, 0.1, 0.01), true};
  const double a = GENERATE(35.0, 50.0) * degree;
  System s = slope(a);
  s.hold(cdem::Selection::of_body("slider"), "x");
  REQUIRE(s.relax(1e-9).converged); // pressed against the slope by its weight, then let go
  s.conditions.fixes.pop_back();
  const double exact = earth_gravity * (std::sin(a) - std::tan(phi) * std::cos(a));
  // From 0.2 % of its length to 1.2 %, as if it had come from rest.
  const double start = std::sqrt(2 * exact * 0.002 * slope.size),
               end = std::sqrt(2 * exact * 0.012 * slope.size);
  for (int i = 0; i < static_cast<int>(s.state.displacement.size()); ++i)
    if (s.model.blocks[block_of(s.model, i)].body == 1)
      s.state.velocity[i] = {start, 0, 0, 0};
  cdem::RunOptions options;
  options.duration = 0.1 * (end - start) / exact; // until the shear springs are stretched to their limit
  s.run(options);
  const double before = slider_velocity(s);
  options.duration *= 9;
  const double time = s.state.time;
  const cdem::RunResult run = s.run(options);
  CAPTURE(slope.size, run.steps);
  CHECK((slider_velocity(s) - before) / (run.time - time) == Approx(exact).epsilon(0.005));
}

TEST_CASE("a block sticks on an incline below the friction angle", "[friction]") {
  const Slope slope{GENERATE(1.0, 0.1, 0.01)};
  const double a = 29 * degree;
  System s = slope(10 * degree);
  REQUIRE(s.relax(1e-6).converged);
  Slope::tilt(s, a);
  REQUIRE(s.relax(1e-6).converged);
  // Elastic shift of springs and block only: weight along the slope over the shear stiffness, with room for
  // the block's own shear.
  const cdem::Interface& face = s.model.interfaces.back();
  const double stress = rock().density * earth_gravity * 0.1 * slope.size * std::sin(a);
  double shift = 0;
  for (const cdem::Node& u : s.state.displacement)
    shift = std::max(shift, std::abs(u.x));
  CHECK(shift < 3 * stress * (1 / face.ks + 0.1 * slope.size / rock().shear_modulus()));

  // In real time as well: it stays.
  const double before = s.state.displacement.back().x;
  cdem::RunOptions options;
  options.steps = 20000;
  s.run(options);
  CHECK(std::abs(s.state.displacement.back().x - before) < stress / face.ks);
}

TEST_CASE("a block thrown off its base loses at each bounce what the dashpots of a dry joint take",
          "[friction]") {
  // The contact is soft: its period is more than 20 times the block's own.
  cdem::Joint contact;
  contact.bonded = false;
  contact.normal_stiffness = 2e8;
  contact.shear_stiffness = 1e8;
  const double h = 0.1;
  System s(build({body("base", geom::grid({h, h, h}, {1, 1, 1}, {0, 0, -h})),
                  body("ball", geom::grid({h, h, h}, {1, 1, 1}))},
                 {{"base", "ball", contact}}));
  s.hold(cdem::Selection::of_body("base"), "xyz");
  s.conditions.gravity = cdem::Gravity{};
  s.conditions.gravity->acceleration = {0, 0, -earth_gravity};
  const double contact_period = 2 * pi * std::sqrt(rock().density * h / 2e8);
  const double own_period = 2 * h / std::sqrt(rock().youngs_modulus / rock().density);
  REQUIRE(contact_period > 20 * own_period);
  const double v0 = 0.5, height = v0 * v0 / (2 * earth_gravity);
  const int centre = s.model.blocks.back().centroid_node();
  for (int i = s.model.blocks.back().node_begin; i < s.model.blocks.back().node_end; ++i)
    s.state.velocity[i].z = v0;

  std::vector<double> tops;
  double before = v0;
  cdem::RunOptions options;
  options.duration = 4.5 * 2 * v0 / earth_gravity;
  options.callback_every = 1;
  options.callback = [&] {
    const double v = s.state.velocity[centre].z, u = s.state.displacement[centre].z;
    if (before > 0 && v <= 0 && u > 0.5 * height)
      tops.push_back(u);
    before = v;
  };
  const double stable = s.run(options).time_step / (options.safety * cdem::stable_step_of_dry_joints(1));
  REQUIRE(tops.size() >= 4);
  // Half a period of the contact at the damping ratio omega T / 8.
  const double ratio = 2 * pi / contact_period * stable / 8, left = std::exp(-2 * pi * ratio);
  CHECK(left > 0.99);
  for (std::size_t i = 0; i < tops.size(); ++i)
    CHECK(tops[i] == Approx(height * std::pow(left, i)).epsilon(0.001));
}
