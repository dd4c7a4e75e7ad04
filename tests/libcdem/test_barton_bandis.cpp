// Rough joints after Barton and Bandis: the formulas of the papers, evaluated here by themselves.
#include "libcdem/joint/joint_law.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using Catch::Matchers::Contains;
using geom::Vec3;

using testing::degree;

namespace {

const cdem::JointSpring stiff{1e12, 1e11, 0};

cdem::BartonBandis
joint(double jrc = 8.9) { // the mean of Barton and Choubey's 136 joints: JRC 8.9, JCS 92 MPa, 27.5 deg
  cdem::BartonBandis law;
  law.jrc = jrc;
  law.jcs = 92e6;
  law.residual_angle = 27.5 * degree;
  law.initial_stiffness = 5e9;
  law.maximum_closure = 0.2e-3;
  return law;
}

} // namespace

TEST_CASE("Barton and Choubey's strength is that of the formula", "[joint_law][barton_bandis]") {
  const cdem::BartonBandis law = joint();
  for (const double p : {0.1e6, 0.5e6, 1e6, 5e6, 20e6}) {
    const double angle = 8.9 * std::log10(92e6 / p) + 27.5;
    CHECK(law.strength(stiff, p, 0) == Approx(p * std::tan(angle * degree)));
  }
  CHECK(law.strength(stiff, 1e6, 0) == Approx(1e6 * std::tan(44.9776 * degree)).epsilon(1e-5));
  CHECK(law.strength(stiff, 92e6, 0) == Approx(92e6 * std::tan(27.5 * degree))); // no roughness is left
  CHECK(law.strength(stiff, 200e6, 0) == Approx(200e6 * std::tan(27.5 * degree)));
  CHECK(law.strength(stiff, 1, 0) == Approx(std::tan(70 * degree))); // 8.9 log10(92e6) + 27.5 is above 70
  CHECK(law.strength(stiff, 0, 0) == 0);
  CHECK(law.strength(stiff, -1e6, 0) == 0);
}

TEST_CASE("the tangent of the strength is its slope", "[joint_law][barton_bandis]") {
  const cdem::BartonBandis law = joint();
  for (const double p : {100.0, 0.2e6, 1e6, 10e6, 150e6}) {
    const double h = 1e-4 * p;
    CHECK(law.tangent(p) ==
          Approx((law.strength(stiff, p + h, 0) - law.strength(stiff, p - h, 0)) / (2 * h)).epsilon(1e-5));
  }
}

TEST_CASE("roughness is mobilised and worn as Barton, Bandis and Bakhtar tabulate it",
          "[joint_law][barton_bandis]") {
  cdem::BartonBandis law = joint();
  law.peak_slip = 1e-3;
  const double p = 1e6, i = 8.9 * std::log10(92.0);
  const double table[][2] = {{0.6, 0.75}, {1, 1},    {2, 0.85}, {4, 0.7},
                             {10, 0.5},   {25, 0.4}, {100, 0},  {200, 0}};
  for (const auto& row : table)
    CHECK(law.strength(stiff, p, row[0] * law.peak_slip) ==
          Approx(p * std::tan((27.5 + i * row[1]) * degree)));
  CHECK(law.strength(stiff, p, 0) == 0);
  CHECK(law.strength(stiff, p, 0.3 * law.peak_slip) == Approx(p * std::tan(27.5 * degree)));
  CHECK(law.strength(stiff, p, 0.15 * law.peak_slip) == Approx(p * std::tan(13.75 * degree)));
  CHECK(law.rise(stiff, p, 0.2 * law.peak_slip, 0, 1e-4) == 0); // no roughness yet
  CHECK(law.rise(stiff, p, law.peak_slip, 0, 1e-4) == Approx(1e-4 * std::tan(0.5 * i * degree)));
  CHECK(law.rise(stiff, p, 100 * law.peak_slip, 0, 1e-4) == Approx(0));
}

TEST_CASE("a joint of some length is smoother, weaker and slower to its peak than samples",
          "[joint_law][barton_bandis]") {
  cdem::BartonBandis law = joint(15);
  law.jcs = 150e6;
  scale_to_length(law, 1.0, 0.1);
  CHECK(law.jrc == Approx(15 * std::pow(10, -0.02 * 15)));
  CHECK(law.jcs == Approx(150e6 * std::pow(10, -0.03 * 15)));
  CHECK(law.peak_slip == Approx(1.0 / 500 * std::pow(law.jrc / 1.0, 0.33)));
}

TEST_CASE("closure follows Bandis's hyperbola, and straight on at the stiffness of the spring",
          "[joint_law][barton_bandis]") {
  const cdem::BartonBandis law = joint();
  for (const double v : {0.01e-3, 0.1e-3, 0.18e-3})
    CHECK(law.pressure(stiff, v) == Approx(5e9 * v / (1 - v / 0.2e-3)));
  const double end = 0.2e-3 * (1 - std::sqrt(5e9 / 1e12)); // where the hyperbola is as stiff as the spring
  CHECK(law.pressure(stiff, end + 1e-5) == Approx(law.pressure(stiff, end) + 1e12 * 1e-5));
  for (const double v : {0.05e-3, 0.15e-3, 0.1999e-3, 0.3e-3}) {
    CHECK(law.closure(stiff, law.pressure(stiff, v)) == Approx(v));
    const double h = 1e-9; // the pressure is the slope of what is stored
    CHECK((law.stored(stiff, v + h) - law.stored(stiff, v - h)) / (2 * h) ==
          Approx(law.pressure(stiff, v)).epsilon(1e-5));
  }
}

TEST_CASE("sheared under a constant pressure the joint follows the curve of its mobilised strength",
          "[joint_law][barton_bandis]") {
  cdem::BartonBandis law = joint();
  scale_to_length(law, 1, 0.1);
  const cdem::JointLaw any = law;
  const Vec3 normal(0, 0, 1);
  const double p = 1e6;
  Vec3 offset = Vec3::Zero();
  cdem::JointHistory history;
  double z = -law.closure(stiff, p), peak = 0, peak_at = 0;
  cdem::JointResponse r;
  for (int i = 1; i <= 2000; ++i) {
    const double x = 10e-6 * i;
    for (int k = 0; k < 50; ++k) {
      r = cdem::joint_response(any, stiff, normal, {x, 0, z}, offset, history);
      z += law.closure(stiff, std::max(0.0, -r.traction.z())) - law.closure(stiff, p);
    }
    offset = r.offset;
    history = r.history;
    if (r.traction.x() > peak) {
      peak = r.traction.x();
      peak_at = x;
    }
  }
  CHECK(peak == Approx(p * std::tan(law.friction_angle(p, law.peak_slip))).epsilon(0.002));
  CHECK(peak_at == Approx(law.peak_slip).epsilon(0.02));
  CHECK(r.traction.x() == Approx(p * std::tan(law.friction_angle(p, history.path))).epsilon(0.002));
  CHECK(history.dilation > 0);
}

TEST_CASE("values that no joint has are refused", "[joint_law][barton_bandis]") {
  const auto refusal = [](cdem::BartonBandis law) {
    try {
      law.validate();
      law.validate(stiff);
    } catch (const geom::InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(refusal(joint()).empty());
  CHECK_THAT(refusal(joint(25)), Contains("jrc = 25") && Contains("[0, 20]"));
  cdem::BartonBandis law = joint();
  law.maximum_closure = 0;
  CHECK_THAT(refusal(law), Contains("maximum_closure = 0"));
  law = joint();
  law.initial_stiffness = 2e12;
  CHECK_THAT(refusal(law), Contains("initial_stiffness = 2e+12") && Contains("raise normal_stiffness"));
}
