// Law of one spring (Han 2010 eqs 9-11, amended): pure functions, random inputs.
#include "libcdem/joint/spring_law.hpp"
#include "libgeom/core/random.hpp"

#include <catch2/catch.hpp>

using namespace cdem;
using geom::Vec3;

namespace {

struct Random {
  std::uint64_t id, next = 0;
  double operator()(double low, double high) { return low + (high - low) * geom::uniform(3, id, next++); }
  Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

Vec3 shear_part(const Vec3& v, const Vec3& n) {
  return v - v.dot(n) * n;
}

} // namespace

TEST_CASE("a contact never pulls and its traction stays in the friction cone", "[springs]") {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random r{i};
    const Vec3 n = r.vector(1).normalized();
    const double kn = r(1e8, 1e12), ks = r(1e8, 1e12), tan_friction = r(0, 1.5);
    Vec3 offset = r.vector(1e-5);
    for (int step = 0; step < 20; ++step) {
      const Vec3 jump = r.vector(1e-5);
      const SpringResponse now = contact_response(kn, ks, tan_friction, n, jump, offset);
      const double tn = now.traction.dot(n), ts = shear_part(now.traction, n).norm();
      const double open = (jump - offset).dot(n);
      CHECK(tn <= 0);
      CHECK(ts <= -tn * tan_friction + 1e-9 * ks * 1e-5);
      // Coulomb friction never changes where the faces touch.
      CHECK(std::abs((now.offset - offset).dot(n)) <= 1e-14 * 1e-5);
      if (open > 0)
        CHECK(now.traction.norm() == 0);
      else
        CHECK(tn == Approx(kn * open).epsilon(1e-9));
      // Slip goes along the shear traction: friction takes energy, never gives it.
      CHECK(now.traction.dot(now.offset - offset) >= -1e-12 * ks * 1e-10);
      offset = now.offset;
    }
  }
}

TEST_CASE("within the friction cone a contact is elastic and remembers no slip", "[springs]") {
  const Vec3 n = Vec3::UnitZ();
  const double kn = 2e9, ks = 1e9;
  const Vec3 jump(1e-6, 2e-6, -1e-5), offset(3e-7, 0, 0);
  const SpringResponse r = contact_response(kn, ks, 0.5, n, jump, offset);
  CHECK((r.traction - Vec3(ks * 7e-7, ks * 2e-6, -kn * 1e-5)).norm() < 1e-6);
  CHECK(r.offset == offset);
}

TEST_CASE("a contact that opens forgets its slip: closed again it starts without shear", "[springs]") {
  const Vec3 n = Vec3::UnitZ();
  const double kn = 2e9, ks = 1e9, mu = 0.5;
  Vec3 offset = Vec3::Zero();
  offset = contact_response(kn, ks, mu, n, {5e-6, 0, -1e-6}, offset).offset;
  CHECK(offset.x() == Approx(5e-6 - mu * kn * 1e-6 / ks)); // slipped
  const SpringResponse open = contact_response(kn, ks, mu, n, {9e-6, 4e-6, 1e-7}, offset);
  CHECK(open.traction.norm() == 0);
  CHECK((open.offset - Vec3(9e-6, 4e-6, 0)).norm() < 1e-18);
  const SpringResponse closed = contact_response(kn, ks, mu, n, {9e-6, 4e-6, -1e-6}, open.offset);
  CHECK((closed.traction - Vec3(0, 0, -kn * 1e-6)).norm() < 1e-9);
}

TEST_CASE("a bond breaks in tension above sigma_t and in shear above c0 - t_n tan phi, never below zero",
          "[springs]") {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random r{i};
    const SpringStrength s{r(0, 1e7), r(0, 1.5), r(0, 1e7)};
    const double tn = r(-2e7, s.tensile_strength);
    const double strength = std::max(0.0, s.cohesion - tn * s.tan_friction);
    CHECK(breaks(s, tn, strength) == BondMode::intact);
    CHECK(breaks(s, tn, strength + 1e-3) == BondMode::broken_shear);
    CHECK(breaks(s, s.tensile_strength, 0) == BondMode::intact);
    CHECK(breaks(s, s.tensile_strength + 1e-3, 0) == BondMode::broken_tension);
  }
}

TEST_CASE("friction follows the mean of the normal force of a contact that has carried for long",
          "[springs]") {
  const double passed = 0.01, pi = 3.14159265358979323846;
  ContactMeans<double> means{0, 0};
  const auto felt = [&](double pressed) {
    return pressed - unfelt_by_friction<double>(pressed, passed, means);
  };
  CHECK(felt(3) == 3); // it begins
  CHECK(means.usual == 3);
  means = {};
  double impulse = 0, of_friction = 0;
  for (int i = 0; i < 31; ++i) { // an impact, half an oscillation
    const double force = std::sin(pi * i / 31);
    impulse += force;
    of_friction += felt(force);
  }
  CHECK(of_friction == Approx(impulse).epsilon(0.005));
  for (int i = 0; i < 63 * 40; ++i) // a vibration of the frequency omega
    felt(2 + std::sin(2 * pi * i / 63));
  for (int i = 0; i < 63; ++i)
    CHECK(felt(2 + std::sin(2 * pi * i / 63)) == Approx(2).epsilon(0.06));
  const double before = means.usual;
  felt(0); // it opens for a moment
  CHECK(means.usual == before);
  CHECK(means.rested == Approx(0.99));
  ContactMeans<double> none{0, 0};
  CHECK(unfelt_by_friction<double>(3, 0, none) == 0); // of rigid blocks
}
