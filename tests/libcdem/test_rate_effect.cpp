// Strength raised by the rate of strain: the two powers, and faces of a cohesive body that crack by it.
#include "libcdem/joint/rate_effect.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

const cdem::RateEffect model_code{1e-6, 0.018, 10, 1.0 / 3, false};

} // namespace

TEST_CASE("rate effect: fib Model Code 2010 for concrete in tension", "[rate]") {
  for (const double rate : {1e-5, 1e-3, 1.0, 10.0})
    CHECK(cdem::dynamic_increase_factor(model_code, rate) ==
          Approx(std::pow(rate / 1e-6, 0.018)).epsilon(1e-12));
  for (const double rate : {20.0, 100.0, 300.0}) // eq 5.1-113b: 0.0062 (rate / 1e-6)^(1/3)
    CHECK(cdem::dynamic_increase_factor(model_code, rate) ==
          Approx(0.0062 * std::cbrt(rate / 1e-6)).epsilon(5e-3));
}

TEST_CASE("rate effect: no less than the static strength, none without, no jump where the powers meet",
          "[rate]") {
  CHECK(cdem::dynamic_increase_factor(model_code, 0) == 1);
  CHECK(cdem::dynamic_increase_factor(model_code, 1e-9) == 1);
  CHECK(cdem::dynamic_increase_factor(model_code, 1e-6) == 1);
  CHECK(cdem::dynamic_increase_factor({}, 100) == 1);
  CHECK(cdem::dynamic_increase_factor(model_code, 10 * (1 + 1e-12)) ==
        Approx(cdem::dynamic_increase_factor(model_code, 10)).epsilon(1e-11));
}

TEST_CASE("rate effect: a bar that is stretched at one rate cracks at the strength of that rate",
          "[rate][cohesive]") {
  const double length = 0.6, speed = GENERATE(0.02, 0.1);
  const bool with_energy = speed > 0.05;
  cdem::Joint joint = concrete_joint(cdem::Softening::linear, 20);
  joint.fracture_energy_1 = 300;
  joint.rate = {1e-3, 0.1, 0.05, 0.25, with_energy};
  System s(build({meshed("bar", unstructured({length, 0.25, 0.25}, 0.12), cohesive(), concrete(), joint)}));
  lead_apart(s.conditions.fixes, speed);
  // All of it moves as it does at the given rate, narrowing too: no wave runs through.
  const double rate = speed / length, nu = concrete().poissons_ratio;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
    const Vec3 x = s.model.node_position[i] - Vec3(length / 2, 0.125, 0.125);
    s.state.velocity[i] = node(rate * Vec3(x.x(), -nu * x.y(), -nu * x.z()));
  }
  cdem::RunOptions options;
  options.steps = 1 << 30;
  options.callback_every = 1;
  double most = 0;
  options.callback = [&] { most = std::max(most, end_traction(s, 0.25 * 0.25)); };
  options.stop = [&] { // in good time after the strength
    return std::any_of(s.state.cohesive.begin(), s.state.cohesive.end(),
                       [](const cdem::CohesiveFace& face) { return face.damage[0] > 0.3; });
  };
  s.run(options);
  const double norm = rate * std::sqrt(1 + 2 * nu * nu);
  const double factor = cdem::dynamic_increase_factor(joint.rate, norm);
  CHECK(factor > 1.4);
  CHECK(most == Approx(factor * 3e6).epsilon(0.03));
  for (std::size_t face = 0; face < s.state.cohesive.size(); ++face)
    if (s.state.faces[face / cdem::lanes].stage[face % cdem::lanes] == cdem::FaceStage::cracking)
      CHECK(s.state.rate_factor[face] == Approx(factor).epsilon(0.05));
}

TEST_CASE("rate effect: wrong input is refused", "[rate][input]") {
  const auto refused = [](const cdem::RateEffect& rate, const char* says) {
    cdem::Joint joint = concrete_joint(cdem::Softening::none);
    joint.rate = rate;
    CHECK_THROWS_WITH(cdem::validate(joint), Catch::Contains(says));
  };
  refused({-1, 0.1}, "rate_effect.reference_rate = -1");
  refused({1e-6, 2}, "rate_effect.exponent = 2");
  refused({1e-6, 0.018, 1e-7, 0.3}, "rate_effect.change_rate = 1e-07");
  refused({1e-6, 0.018, 10, -1}, "rate_effect.exponent_above = -1");

  cdem::Joint joint = concrete_joint(cdem::Softening::none);
  joint.rate = model_code;
  const auto not_there = [&](const cdem::BodySpec& body) {
    cdem::ModelSpec spec;
    spec.bodies = {body};
    CHECK_THROWS_WITH(cdem::Simulation(spec, 1, nullptr),
                      Catch::Contains("rate_effect = of a joint between"));
  };
  cdem::Bonding springs;
  springs.everywhere = true;
  not_there(meshed("bar", unstructured({0.3, 0.2, 0.2}, 0.1), springs, concrete(), joint));
  not_there(body("row", geom::grid({0.4, 0.1, 0.1}, {4, 1, 1}), concrete(), joint));
}
