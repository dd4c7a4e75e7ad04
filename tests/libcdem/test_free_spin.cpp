// A free body that spins keeps its energy and its angular momentum, however many turns it makes. Nothing drives it, so
// whatever the stress update adds to the motion in a step adds up.
#include "libcdem/results/energy.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

using namespace testing;
using geom::Vec3;

namespace {

constexpr int turns = 20, looks_a_turn = 20;

struct Spin {
  double before = 0;                  // J, all of it kinetic
  std::vector<double> gained;         // J, of the total; at moments evenly spread over the spin
  double elastic = 0;                 // J, in the mean
  Vec3 momentum_before, momentum_now; // N m s

  // J, mean of five turns
  double gained_first() const { return mean(gained.begin(), gained.begin() + 5 * looks_a_turn); }
  double gained_last() const { return mean(gained.end() - 5 * looks_a_turn, gained.end()); }

private:
  using Place = std::vector<double>::const_iterator;
  static double mean(Place begin, Place end) {
    return std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
  }
};

// It moves like a rigid body at first and is without stress: from then on it rings about what the spin stretches it by.
Spin spin(const cdem::BodySpec& body, double rate) {
  System s(build({body}));
  const Vec3 centre = centroid(s, 0), axis = Vec3(1, 2, -0.5).normalized();
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node(rate * axis.cross(s.model.node_position[i] - centre));
  Spin spin;
  spin.momentum_before = momentum(s, Places::present).angular;
  spin.before = cdem::energy(s.model, s.state).total();
  cdem::RunOptions options;
  options.safety = 0.9;
  options.duration = turns * 2 * pi / rate;
  options.callback_every = static_cast<std::int64_t>(
      options.duration / (options.safety * cdem::stable_time_step(s.model)) / (turns * looks_a_turn));
  options.callback = [&] {
    const cdem::EnergyLedger now = cdem::energy(s.model, s.state);
    spin.gained.push_back(now.total() - spin.before);
    spin.elastic += now.elastic + now.springs;
  };
  s.run(options);
  spin.elastic /= static_cast<double>(spin.gained.size());
  spin.momentum_now = momentum(s, Places::present).angular;
  return spin;
}

} // namespace

TEST_CASE("free spin: twenty turns change neither energy nor angular momentum", "[spin][mesh]") {
  const double rate = GENERATE(1.0, 100.0); // rad/s
  const bool far_away = GENERATE(false, true);
  const bool bonded = GENERATE(false, true), damped = bonded ? false : GENERATE(false, true);
  cdem::Elastic material = rock();
  if (rate == 1)
    material.youngs_modulus = 3e7; // strains of some 1e-5; at 100 rad/s of some 1e-4
  if (damped)
    material.stiffness_damping = 1e-3 / rate;
  cdem::Bonding bonding;
  bonding.everywhere = bonded;
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = joint.cohesion = 1e12;
  const Vec3 away = far_away ? Vec3(1000, -500, 200) : Vec3(0, 0, 0);
  const Spin s = spin(
      meshed("unit", placed(geom::box_mesh({1, 0.8, 1.2}, {2, 2, 2}, 0.15), geom::Mat3::Identity(), away),
             bonding, material, joint),
      rate);
  REQUIRE(s.gained.size() >= turns * looks_a_turn);
  const auto [least, most] = std::minmax_element(s.gained.begin(), s.gained.end());
  INFO("rate " << rate << ", away " << far_away << ", bonded " << bonded << ", damped " << damped
               << ": energy gained over kinetic " << *least / s.before << " to " << *most / s.before
               << ", elastic over kinetic " << s.elastic / s.before << ", gained over elastic "
               << s.gained_first() / s.elastic << " in the first turns, " << s.gained_last() / s.elastic
               << " in the last");
  CHECK(s.elastic > 5e-6 * s.before);
  CHECK(*least > -1e-3 * s.before);
  CHECK(*most < 1e-3 * s.before);
  CHECK(std::abs(s.gained_last() - s.gained_first()) < 0.01 * s.elastic);
  CHECK((s.momentum_now - s.momentum_before).norm() < 1e-9 * s.momentum_before.norm());
}
