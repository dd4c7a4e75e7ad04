// Mohr-Coulomb plasticity: the return of principal stresses, then whole bodies.
#include "tests/libcdem/system.hpp"

#include "libcdem/material/plasticity.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace testing;
using cdem::Plasticity;
using cdem::RockLimit;
using geom::Mat3;
using geom::Vec3;
using Three = std::array<double, 3>;

namespace {

constexpr double lambda = 1.2e9, shear = 0.8e9;

Plasticity soil(double phi, double psi, double tension = 5e3) {
  Plasticity rock;
  rock.cohesion = rock.residual_cohesion = 20e3;
  rock.friction_angle = rock.residual_friction_angle = phi * degree;
  rock.dilation_angle = psi * degree;
  rock.tensile_strength = rock.residual_tensile_strength = tension;
  return rock;
}

double tip(const RockLimit& r) {
  return r.sin_friction > 0 ? std::min(r.tensile_strength, r.cohesion * r.cos_friction / r.sin_friction)
                            : r.tensile_strength;
}

// Largest of both conditions, Pa: s descending.
double excess(const Three& s, const RockLimit& r) {
  return std::max((1 + r.sin_friction) * s[0] - (1 - r.sin_friction) * s[2] - 2 * r.cohesion * r.cos_friction,
                  s[0] - tip(r));
}

Three back(const Three& e) { // Hooke
  const double p = lambda * (e[0] + e[1] + e[2]);
  return {p + 2 * shear * e[0], p + 2 * shear * e[1], p + 2 * shear * e[2]};
}

Three random_trial(std::mt19937& random, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Three t{uniform(random), uniform(random), uniform(random)};
  if (random() % 4 == 0)
    t[1] = t[random() % 2 * 2];
  std::sort(t.rbegin(), t.rend());
  return t;
}

Mat3 matrix_of(const double (&s)[6]) {
  Mat3 m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return m;
}

void put(const Mat3& m, double (&s)[6]) {
  const double all[6] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)};
  std::copy(std::begin(all), std::end(all), std::begin(s));
}

// A block of 0.1 m between smooth platens, free at its sides.
cdem::Simulation between_platens(const Plasticity& law, const std::array<int, 3>& cells = {1, 1, 1},
                                 int threads = 1) {
  cdem::ModelSpec spec;
  spec.bodies = {body("rock", geom::grid({0.1, 0.1, 0.1}, cells))};
  spec.bodies[0].element = cdem::Element::finite_volume;
  spec.bodies[0].plasticity.laws = {law};
  spec.bodies[0].plasticity.others = 0;
  cdem::Simulation s(spec, threads, nullptr);
  s.fix(fixed(cdem::Selection::side("z-"), "z"));
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  s.fix(fixed(cdem::Selection::side("y-"), "y"));
  return s;
}

// The platens come together by `strain`, at a thousandth of the speed of sound or less.
void press(cdem::Simulation& s, double strain, double velocity = 0.2) {
  cdem::Fix platen = fixed(cdem::Selection::side("z+"), "z");
  platen.displacement.reset();
  platen.velocity = Vec3(0, 0, -velocity);
  s.fix(platen);
  cdem::RunOptions options;
  options.duration = 0.1 * strain / velocity;
  options.breaking = false;
  options.local_damping = 0.1;
  s.run(options);
}

double stress_zz(const cdem::Simulation& s) {
  double sum = 0, volume = 0;
  for (const auto& block : s.blocks()) {
    sum += block.volume * block.stress[2];
    volume += block.volume;
  }
  return sum / volume;
}

} // namespace

TEST_CASE("a stress beyond the strength returns to it, by Hooke's law and along the flow", "[plasticity]") {
  std::mt19937 random(7);
  for (const double phi : {0.0, 10.0, 30.0, 45.0})
    for (const double psi : {0.0, 0.5 * phi, phi})
      for (const double tension : {0.0, 5e3, 1e6}) {
        const RockLimit rock = cdem::limit_at(soil(phi, psi, tension), 0);
        int yields = 0, most_planes = 0;
        for (int i = 0; i < 400; ++i) {
          const Three t = random_trial(random, i % 2 ? 1e5 : 1e6);
          const cdem::PlasticReturn r = cdem::return_to_limit(t, lambda, shear, rock);
          CAPTURE(phi, psi, tension, t[0], t[1], t[2], r.stress[0], r.stress[1], r.stress[2], r.planes);
          if (excess(t, rock) <= 0) {
            CHECK(r.planes == 0);
            CHECK(r.stress == t);
            continue;
          }
          ++yields;
          most_planes = std::max(most_planes, r.planes);
          const double small = 1e-3; // Pa
          CHECK(r.stress[0] >= r.stress[1] - small);
          CHECK(r.stress[1] >= r.stress[2] - small);
          CHECK(std::abs(excess(r.stress, rock)) < small);
          const Three c = back(r.strain);
          for (int k = 0; k < 3; ++k)
            CHECK(std::abs(t[k] - c[k] - r.stress[k]) < small);
          double work = 0;
          for (int k = 0; k < 3; ++k)
            work += r.stress[k] * r.strain[k];
          CHECK(work >= -1e-9 * std::abs(t[2]));
          const cdem::PlasticReturn again = cdem::return_to_limit(r.stress, lambda, shear, rock);
          for (int k = 0; k < 3; ++k)
            CHECK(std::abs(again.stress[k] - r.stress[k]) < small);
          // Associated: the nearest of all stresses that the rock bears, in the norm of the elastic energy.
          if (psi == phi)
            for (int other = 0; other < 5; ++other) {
              const Three s = cdem::return_to_limit(random_trial(random, 3e5), lambda, shear, rock).stress;
              double more = 0;
              for (int k = 0; k < 3; ++k)
                more += (s[k] - r.stress[k]) * r.strain[k];
              CHECK(more <= 1e-7 * (std::abs(t[0]) + std::abs(t[2])));
            }
        }
        CHECK(yields > 50);
        CHECK(most_planes >= 2);
      }
}

TEST_CASE("each face, edge and corner of the limit", "[plasticity]") {
  const RockLimit rock = cdem::limit_at(soil(30, 10, 5e3), 0);
  const auto to = [&](const Three& t) { return cdem::return_to_limit(t, lambda, shear, rock); };
  const double n = (1 + rock.sin_friction) / (1 - rock.sin_friction), q = 2 * 20e3 * std::sqrt(n);
  SECTION("shear face") {
    const Three t{-50e3, -200e3, -500e3};
    const auto r = to(t);
    CHECK(r.planes == 1);
    CHECK(r.stress[2] == Approx(n * r.stress[0] - q));
    CHECK(r.strain[0] / -r.strain[2] == Approx((1 + rock.sin_dilation) / (1 - rock.sin_dilation)));
    CHECK(r.strain[1] == Approx(0).margin(1e-15));
  }
  SECTION("edge of triaxial compression and of extension") {
    const auto compression = to({-50e3, -50e3, -800e3});
    CHECK(compression.planes == 2);
    CHECK(compression.stress[0] == Approx(compression.stress[1]));
    CHECK(compression.stress[2] == Approx(n * compression.stress[0] - q));
    const auto extension = to({-50e3, -800e3, -800e3});
    CHECK(extension.planes == 2);
    CHECK(extension.stress[1] == Approx(extension.stress[2]));
  }
  SECTION("tension: face, edge, corner") {
    const auto face = to({20e3, -5e3, -8e3});
    CHECK(face.planes == 1);
    CHECK(face.stress[0] == Approx(5e3));
    CHECK(face.stress[1] == Approx(-5e3 - 15e3 * lambda / (lambda + 2 * shear)));
    const auto edge = to({20e3, 20e3, -8e3});
    CHECK(edge.stress[0] == Approx(5e3));
    CHECK(edge.stress[1] == Approx(5e3));
    const auto corner = to({90e3, 60e3, 50e3});
    CHECK(corner.planes == 3);
    for (const double s : corner.stress)
      CHECK(s == Approx(5e3));
  }
  SECTION("tension and shear together") {
    const Three corner{5e3, -20e3, n * 5e3 - q};
    const Three c = back({1e-4 * (1 + rock.sin_dilation) + 2e-4, 0, -1e-4 * (1 - rock.sin_dilation)});
    const auto r = to({corner[0] + c[0], corner[1] + c[1], corner[2] + c[2]});
    CHECK(r.planes == 2);
    for (int k = 0; k < 3; ++k)
      CHECK(r.stress[k] == Approx(corner[k]));
    CHECK(r.strain[0] == Approx(1e-4 * (1 + rock.sin_dilation) + 2e-4));
  }
  SECTION("the tip of the cone, where there is no cut-off") {
    const RockLimit cone = cdem::limit_at(soil(30, 10, 1e9), 0);
    for (const double s : cdem::return_to_limit({1e6, 1e6, 1e6}, lambda, shear, cone).stress)
      CHECK(s == Approx(20e3 * std::sqrt(3.0)));
  }
}

TEST_CASE("the bound of the kernel overlooks no stress beyond the strength", "[plasticity]") {
  std::mt19937 random(3);
  Plasticity rock = soil(35, 5, 8e3);
  rock.residual_cohesion = 1e3;
  rock.residual_friction_angle = 20 * degree;
  rock.residual_tensile_strength = 0;
  rock.softening_strain = 0.01;
  const auto bounds = cdem::bounds(rock);
  int near = 0;
  for (int i = 0; i < 20000; ++i) {
    const Three t = random_trial(random, 1e5);
    const double p = (t[0] + t[1] + t[2]) / 3;
    double j2 = 0;
    for (const double s : t)
      j2 += 0.5 * (s - p) * (s - p);
    bool beyond = false;
    for (const cdem::PlasticBound& b : bounds) {
      const double r = b.strength - b.slope * p, tension = b.tensile - p;
      beyond = beyond || r <= 0 || b.reach * j2 >= r * r || tension <= 0 || 4.0 / 3 * j2 >= tension * tension;
    }
    bool yields = false;
    for (const double strain : {0.0, 0.003, 0.01, 0.02})
      yields = yields || excess(t, cdem::limit_at(rock, strain)) > 0;
    near += beyond && !yields ? 1 : 0;
    if (yields)
      CHECK(beyond);
  }
  CHECK(near < 10000); // else it sees nothing
}

TEST_CASE("strength falls linearly over the plastic strain", "[plasticity]") {
  Plasticity rock = soil(30, 20, 6e3);
  rock.residual_cohesion = 4e3;
  rock.residual_tensile_strength = 0;
  rock.residual_friction_angle = 10 * degree;
  rock.softening_strain = 0.02;
  const RockLimit half = cdem::limit_at(rock, 0.01), end = cdem::limit_at(rock, 0.05);
  CHECK(half.cohesion == Approx(12e3));
  CHECK(half.tensile_strength == Approx(3e3));
  CHECK(half.sin_friction / half.cos_friction ==
        Approx(0.5 * (std::tan(30 * degree) + std::tan(10 * degree))));
  CHECK(end.cohesion == Approx(4e3));
  CHECK(end.sin_friction == Approx(std::sin(10 * degree)));
  CHECK(end.sin_dilation == Approx(std::sin(10 * degree))); // never above friction
}

TEST_CASE("a turned stress returns to the turned one, with the same work", "[plasticity]") {
  std::mt19937 random(11);
  const cdem::RockLimit rock = cdem::limit_at(soil(25, 5), 0);
  for (int i = 0; i < 50; ++i) {
    const Mat3 q = rotation(Vec3::Random().normalized(), 1.0 + i);
    const Three t = random_trial(random, 4e5);
    const Mat3 plain = Vec3(t[2], t[0], t[1]).asDiagonal();
    double from[6] = {}, one[6], other[6], strain_one = 0, strain_other = 0;
    put(plain, one);
    put(q * plain * q.transpose(), other);
    const double work = cdem::plastic_step(rock, lambda, shear, from, one, strain_one);
    const double work_turned = cdem::plastic_step(rock, lambda, shear, from, other, strain_other);
    CHECK((q * matrix_of(one) * q.transpose() - matrix_of(other)).norm() < 1e-6 * 4e5);
    CHECK(work_turned == Approx(work).margin(1e-12));
    CHECK(strain_other == Approx(strain_one).margin(1e-15));
  }
}

TEST_CASE("a block between smooth platens bears 2 c cos(phi) / (1 - sin(phi)) and no more", "[plasticity]") {
  for (const double psi : {0.0, 30.0}) {
    Plasticity law = soil(30, psi, 1e6);
    law.cohesion = law.residual_cohesion = 10e6;
    const double strength = 2 * 10e6 * std::sqrt(3.0), elastic = strength / rock().youngs_modulus;
    cdem::Simulation s = between_platens(law);
    press(s, 0.9 * elastic);
    CHECK(stress_zz(s) == Approx(-0.9 * strength).epsilon(0.02));
    CHECK(s.energy().plastic == 0);
    press(s, 4 * elastic);
    CAPTURE(psi);
    CHECK(stress_zz(s) == Approx(-strength).epsilon(0.005));
    // Beyond the elastic part the platens do the work of the strength.
    CHECK(s.energy().plastic == Approx(strength * 3.9 * elastic * 1e-3).epsilon(0.02));
    CHECK(s.energy().balance_error() < 2e-3);
  }
}

TEST_CASE("relaxed in one increment or many a block ends on its strength", "[plasticity][relax]") {
  Plasticity law = soil(30, 0, 1e6);
  law.cohesion = law.residual_cohesion = 10e6;
  const double strength = 2 * 10e6 * std::sqrt(3.0), elastic = strength / rock().youngs_modulus;
  const auto short_of = [&](int increments) { // of its strength
    cdem::Simulation s = between_platens(law, {2, 2, 2});
    cdem::RelaxOptions options;
    options.residual = 1e-6;
    for (int i = 1; i <= increments; ++i) {
      cdem::Fix platen = fixed(cdem::Selection::side("z+"), "z");
      platen.displacement = Vec3(0, 0, -0.1 * 2 * elastic * i / increments);
      s.fix(platen);
      REQUIRE(s.relax(options).converged);
    }
    return 1 + stress_zz(s) / strength;
  };
  const double one = short_of(1), four = short_of(4), sixteen = short_of(16);
  CAPTURE(one, four, sixteen);
  CHECK(std::abs(one) < 0.01);
  CHECK(std::abs(four) < 0.01);
  CHECK(std::abs(sixteen) < 0.01);
}

TEST_CASE("softening ends at the residual strength", "[plasticity]") {
  Plasticity law = soil(30, 0, 1e6);
  law.cohesion = 10e6;
  law.residual_cohesion = 4e6;
  law.softening_strain = 1e-3;
  const double peak = 2 * 10e6 * std::sqrt(3.0), residual = 0.4 * peak;
  cdem::Simulation s = between_platens(law);
  press(s, 0.99 * peak / rock().youngs_modulus);
  CHECK(stress_zz(s) < -0.95 * peak);
  press(s, 0.01);
  CHECK(stress_zz(s) == Approx(-residual).epsilon(0.01));
}

TEST_CASE("plastic flow has the same bits for every number of threads, and balances in time",
          "[plasticity]") {
  Plasticity law = soil(30, 10, 1e6);
  law.cohesion = law.residual_cohesion = 1e6;
  const auto flow = [&](int threads) {
    cdem::Simulation s = between_platens(law, {4, 4, 4}, threads);
    press(s, 2e-3, 0.5);
    return s;
  };
  const cdem::Simulation one = flow(1), three = flow(3);
  CHECK(one.state_hash() == three.state_hash());
  CHECK(one.energy().plastic > 0.3 * one.energy().external);
  CHECK(one.energy().balance_error() < 2e-3);
}

TEST_CASE("a plastic state is saved and goes on with the same bits", "[plasticity]") {
  Plasticity law = soil(30, 10, 1e6);
  law.cohesion = 2e6;
  law.residual_cohesion = 1e6;
  law.softening_strain = 1e-3;
  cdem::Simulation s = between_platens(law, {2, 2, 2});
  press(s, 1e-3, 0.5);
  cdem::Simulation other = between_platens(law, {2, 2, 2});
  other.restore(s.save());
  CHECK(other.state_hash() == s.state_hash());
  press(s, 5e-4, 0.5);
  press(other, 5e-4, 0.5);
  CHECK(other.state_hash() == s.state_hash());
}

TEST_CASE("plasticity and cohesive faces in one body are refused with what takes both",
          "[plasticity][input]") {
  cdem::Bonding cohesive;
  cohesive.kind = cdem::BondKind::cohesive;
  cohesive.everywhere = true;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("rock", geom::box_mesh({1, 1, 1}, {1, 1, 1}), cohesive)};
  spec.bodies[0].plasticity.laws = {soil(30, 0)};
  CHECK_THROWS_WITH(cdem::Simulation(spec, 1, nullptr), Catch::Matchers::Contains("bonds = \"springs\""));
}

TEST_CASE("a law of plasticity says what is wrong with it", "[plasticity]") {
  Plasticity law = soil(30, 31);
  CHECK_THROWS_WITH(cdem::validate(law), Catch::Matchers::Contains("dilation_angle = 31"));
  law = soil(30, 0);
  law.residual_cohesion = 30e3;
  CHECK_THROWS_WITH(cdem::validate(law), Catch::Matchers::Contains("residual_cohesion = 30000"));
  law = soil(30, 0);
  law.tensile_strength = -1;
  CHECK_THROWS_WITH(cdem::validate(law), Catch::Matchers::Contains("tensile_strength = -1"));
}
