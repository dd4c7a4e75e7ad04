// Plane P waves in a confined column of cubes.
#include "tests/libcdem/columns.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

struct Wave {
  Bar bar;
  double modulus, impedance, speed; // Pa, rho c in Pa s/m, m/s: long waves, joints in series
  explicit Wave(int blocks) {
    bar.blocks = blocks;
    bar.length = 0.01 * blocks;
    bar.poissons_ratio = 0.25;
    modulus = bar.wave_modulus_confined();
    speed = std::sqrt(modulus / bar.material().density);
    impedance = bar.material().density * speed;
  }
};

// Velocity over time at places of a column pushed at x-, sampled every step.
struct Records {
  std::vector<double> time;
  std::vector<std::vector<double>> velocity; // per place
};

Records push(System& s, const cdem::Traction& traction, const std::vector<double>& places, double tolerance,
             double duration) {
  s.hold(cdem::Selection::everything(), "yz");
  s.conditions.tractions = {traction};
  std::vector<std::vector<int>> nodes;
  for (const double x : places)
    nodes.push_back(nodes_at(s.model, x, tolerance));
  Records r;
  r.velocity.resize(places.size());
  cdem::RunOptions options;
  options.duration = duration;
  options.breaking = false;
  options.callback_every = 1;
  options.callback = [&] {
    // Velocities stand half a step before the time of the displacements.
    r.time.push_back(s.state.time * (1 - 0.5 / static_cast<double>(s.state.step)));
    for (std::size_t k = 0; k < places.size(); ++k)
      r.velocity[k].push_back(mean_velocity_x(s, nodes[k]));
  };
  s.run(options);
  return r;
}

double first_time_above(const Records& r, std::size_t place, double level) {
  const auto& v = r.velocity[place];
  for (std::size_t i = 1; i < v.size(); ++i)
    if (v[i] >= level)
      return r.time[i] - (r.time[i] - r.time[i - 1]) * (v[i] - level) / (v[i] - v[i - 1]);
  return -1;
}

// Amplitude of the part at angular frequency omega over whole periods from t0 on.
double amplitude(const Records& r, std::size_t place, double omega, double t0, int periods) {
  double sine = 0, cosine = 0, duration = 0;
  for (std::size_t i = 1; i < r.time.size(); ++i) {
    const double t = r.time[i], dt = t - r.time[i - 1];
    if (t < t0 || t >= t0 + periods * 2 * pi / omega)
      continue;
    sine += r.velocity[place][i] * std::sin(omega * t) * dt;
    cosine += r.velocity[place][i] * std::cos(omega * t) * dt;
    duration += dt;
  }
  return 2 * std::hypot(sine, cosine) / duration;
}

} // namespace

TEST_CASE(
    "a pressure step in a confined column runs at sqrt((lambda + 2 mu) / rho) with v = sigma0 / (rho c)",
    "[waves]") {
  const Wave w(150);
  const double length = w.bar.length, sigma0 = 1e6;
  System s = w.bar.system();
  cdem::Traction step;
  step.on = cdem::Selection::side("x-");
  step.stress = {sigma0, 0, 0};
  const double near = 0.2 * length, far = 0.8 * length;
  const Records r = push(s, step, {near, far}, 0.3 * w.bar.h(), 0.95 * length / w.speed);
  const double v = sigma0 / w.impedance;
  const double speed = (far - near) / (first_time_above(r, 1, v / 2) - first_time_above(r, 0, v / 2));
  CHECK(speed == Approx(w.speed).epsilon(0.01));

  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < r.time.size(); ++i)
    if (r.time[i] > 0.4 * length / w.speed) {
      sum += r.velocity[0][i];
      ++count;
    }
  CHECK(sum / count == Approx(v).epsilon(0.01));
}

TEST_CASE("an elastic joint lets 1 / sqrt(1 + (omega rho c / 2 k)^2) of a wave through", "[waves]") {
  const Wave w(180);
  const double h = w.bar.h(), wave_length = 25 * h, period = wave_length / w.speed, omega = 2 * pi / period;
  const int joint_at = 100;
  const double behind = (joint_at + 25) * h;
  const auto behind_joint = [&](double stiffness) {
    cdem::Joint joint = w.bar.joint();
    if (stiffness > 0)
      joint.normal_stiffness = stiffness;
    geom::Assembly front = geom::grid({joint_at * h, h, h}, {joint_at, 1, 1});
    geom::Assembly back =
        geom::grid({w.bar.length - joint_at * h, h, h}, {180 - joint_at, 1, 1}, {joint_at * h, 0, 0});
    System s(build({body("front", front, w.bar.material(), w.bar.joint()),
                    body("back", back, w.bar.material(), w.bar.joint())},
                   {{"front", "back", joint}}));
    cdem::Traction push_it;
    push_it.on = cdem::Selection::side("x-");
    push_it.stress = {1e6, 0, 0};
    push_it.amplitude = [=](double t) { // smooth start over two periods
      const double start = t < 2 * period ? 0.5 - 0.5 * std::cos(0.5 * pi * t / period) : 1;
      return start * std::sin(omega * t);
    };
    const Records r = push(s, push_it, {behind}, 0.3 * h, 9 * period);
    // The start has passed after 5 + 2 periods; the far end's echo is back after 9.
    return amplitude(r, 0, omega, 7 * period, 2);
  };
  const double incident = behind_joint(0);
  CHECK(incident == Approx(1e6 / w.impedance).epsilon(0.02));
  for (const double ratio : {0.5, 1.0, 2.0}) { // omega rho c / 2 k
    // The joint replaces one of the column's own, which is part of the effective medium: only the rest is
    // extra.
    const double own = w.bar.material().youngs_modulus / (w.bar.thickness_ratio * h);
    const double extra = omega * w.impedance / (2 * ratio);
    const double stiffness = 1 / (1 / own + 1 / extra);
    INFO("omega rho c / 2 k = " << ratio);
    CHECK(behind_joint(stiffness) / incident == Approx(1 / std::sqrt(1 + ratio * ratio)).epsilon(0.02));
  }
}
