// The generalised Hoek-Brown strength: its constants, plasticity that returns to it, and faces that crack at it.
#include "libcdem/fracture/critical_plane.hpp"
#include "libcdem/joint/hoek_brown.hpp"
#include "libcdem/joint/strength_reduction.hpp"
#include "libcdem/material/plasticity.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

const cdem::RockMass average{30e6, 50, 10, 0};

cdem::Plasticity rock_mass(double residual_gsi, double softening_strain) {
  cdem::Plasticity law;
  law.curve = cdem::hoek_brown(average);
  cdem::RockMass residual = average;
  residual.geological_strength = residual_gsi;
  law.residual_curve = cdem::hoek_brown(residual);
  law.tensile_strength = cdem::uniaxial_tensile_strength(law.curve);
  law.residual_tensile_strength = cdem::uniaxial_tensile_strength(law.residual_curve);
  law.softening_strain = softening_strain;
  return law;
}

// A block between smooth platens under a lateral pressure, slowly pressed by this strain; its axial pressure, Pa.
double axial_pressure(const cdem::Plasticity& law, double lateral, double strain) {
  constexpr double size = 0.1, velocity = 0.01; // m, m/s
  cdem::ModelSpec spec;
  spec.bodies = {body("rock", geom::grid({size, size, size}, {1, 1, 1}))};
  spec.bodies[0].element = cdem::Element::finite_volume;
  spec.bodies[0].plasticity.laws = {law};
  spec.bodies[0].plasticity.others = 0;
  cdem::Simulation s(spec, 1, nullptr);
  for (const char* const axis : {"x", "y", "z"})
    s.fix(fixed(cdem::Selection::side(std::string(axis) + "-"), axis));
  s.traction(traction(cdem::Selection::side("x+"), {-lateral, 0, 0}));
  s.traction(traction(cdem::Selection::side("y+"), {0, -lateral, 0}));
  cdem::Fix platen = fixed(cdem::Selection::side("z+"), "z");
  platen.velocity = Vec3(0, 0, -velocity);
  s.fix(platen);
  cdem::RunOptions options;
  options.duration = size * strain / velocity;
  options.local_damping = 0.3;
  s.run(options);
  double sum = 0, volume = 0;
  for (const auto& block : s.blocks()) {
    sum += block.volume * block.stress[2];
    volume += block.volume;
  }
  return -sum / volume;
}

} // namespace

TEST_CASE("Hoek-Brown: constants and strengths of a rock mass", "[hoek_brown]") {
  // Hoek, Carranza-Torres and Corkum 2002 for GSI 50, m_i 10, D 0, written out.
  const cdem::HoekBrown law = cdem::hoek_brown(average);
  CHECK(law.m_b == Approx(1.677).epsilon(1e-3));
  CHECK(law.s == Approx(0.003866).epsilon(1e-3));
  CHECK(law.a == Approx(0.5057).epsilon(1e-4));
  CHECK(cdem::strength(law, 0) == Approx(30e6 * std::pow(law.s, law.a)));
  const double t = cdem::uniaxial_tensile_strength(law);
  CHECK(t == Approx(30e6 * std::pow(law.s - law.m_b * t / 30e6, law.a)));
  CHECK(t < law.s * 30e6 / law.m_b); // where all three principal stresses are equal
  // Intact rock is the law of 1980.
  const cdem::HoekBrown intact = cdem::hoek_brown({100e6, 100, 20, 0});
  for (const double p3 : {0.0, 5e6, 40e6})
    CHECK(cdem::strength(intact, p3) == Approx(p3 + std::sqrt(20 * 100e6 * p3 + 1e16)));
  // Blasting takes from it.
  CHECK(cdem::strength(cdem::hoek_brown({30e6, 50, 10, 1}), 0) < cdem::strength(law, 0));
}

TEST_CASE("Hoek-Brown: no tangent bears less than the curve, and always one chord no more", "[hoek_brown]") {
  const cdem::HoekBrown law = cdem::hoek_brown(average);
  const double t = cdem::uniaxial_tensile_strength(law);
  const auto p1 = [](const cdem::StraightStrength& line, double p3) {
    return (2 * line.cohesion * line.cos_friction + (1 + line.sin_friction) * p3) / (1 - line.sin_friction);
  };
  for (double p3 = -t; p3 < 200e6; p3 += 0.37e6) {
    CHECK(p1(cdem::tangent(law, p3), p3) == Approx(cdem::strength(law, p3)).margin(1));
    for (double at = -t; at < 200e6; at += 13e6)
      CHECK(p1(cdem::tangent(law, at), p3) >= cdem::strength(law, p3) - 1);
    double least = 1e12;
    for (const cdem::StraightStrength& chord : cdem::chords(law))
      least = std::min(least, p1(chord, p3));
    CHECK(least <= cdem::strength(law, p3) + 1);
  }
}

TEST_CASE("Hoek-Brown: stresses beyond it return to it, and the kernel's bound overlooks none",
          "[hoek_brown]") {
  const cdem::Plasticity law = rock_mass(30, 0.01);
  const auto bounds = cdem::bounds(law);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-40e6, 5e6);
  int returned = 0, near = 0;
  for (int i = 0; i < 20000; ++i) {
    std::array<double, 3> trial{uniform(random), uniform(random), uniform(random)};
    std::sort(trial.rbegin(), trial.rend());
    for (const double strain : {0.0, 0.004, 0.02}) {
      const cdem::RockLimit limit = cdem::limit_at(law, strain);
      const double part = std::min(1.0, strain / 0.01);
      const auto excess = [&](const std::array<double, 3>& s) {
        return -s[2] - (1 - part) * cdem::strength(law.curve, -s[0]) -
               part * cdem::strength(law.residual_curve, -s[0]);
      };
      const bool beyond = excess(trial) > 0 || trial[0] > limit.tensile_strength;
      const cdem::PlasticReturn r = cdem::return_to_limit(trial, 1.2e9, 0.8e9, limit);
      CHECK((r.planes > 0) == beyond);
      CHECK(excess(r.stress) < 1e-6 * 30e6);
      CHECK(r.stress[0] <= limit.tensile_strength + 1);
      if (r.planes == 1 && r.stress[0] < limit.tensile_strength - 1) {
        CHECK(excess(r.stress) == Approx(0).margin(1e-6 * 30e6));
        ++returned;
      }
      const double p = (trial[0] + trial[1] + trial[2]) / 3;
      double j2 = 0;
      for (const double s : trial)
        j2 += 0.5 * (s - p) * (s - p);
      bool seen = false;
      for (const cdem::PlasticBound& b : bounds) {
        const double shear = b.strength - b.slope * p, tension = b.tensile - p;
        seen = seen || shear <= 0 || b.reach * j2 >= shear * shear || tension <= 0 ||
               4.0 / 3 * j2 >= tension * tension;
      }
      if (beyond)
        CHECK(seen);
      near += seen && !beyond ? 1 : 0;
    }
  }
  CHECK(returned > 10000);
  CHECK(near < 30000); // else it sees nothing
}

TEST_CASE(
    "Hoek-Brown: a block bears sigma_3 + sigma_ci (m_b sigma_3 / sigma_ci + s)^a, then its residual strength",
    "[hoek_brown][plasticity]") {
  const double lateral = GENERATE(0.0, 0.5e6, 2e6);
  cdem::Plasticity perfect = rock_mass(50, 0), falling = rock_mass(30, 1e-3);
  // Associated where the lateral pressure is low: there the friction angle is near 60 degrees, and flow without dilation is
  // unstable.
  perfect.dilation_angle = falling.dilation_angle = lateral > 1e6 ? 0 : 85 * degree;
  const double peak = axial_pressure(perfect, lateral, 2e-3) / cdem::strength(perfect.curve, lateral),
               residual =
                   axial_pressure(falling, lateral, 6e-3) / cdem::strength(falling.residual_curve, lateral);
  INFO("lateral " << lateral << ", peak " << peak << ", residual " << residual);
  CHECK(peak == Approx(1).epsilon(0.01));
  CHECK(residual == Approx(1).epsilon(0.01));
}

TEST_CASE("Hoek-Brown: a face cracks where the stress meets the curve, on the plane of the tangent",
          "[hoek_brown]") {
  cdem::Joint joint;
  joint.curve = cdem::hoek_brown(average);
  joint.tensile_strength = cdem::uniaxial_tensile_strength(joint.curve);
  const cdem::RockStrength rock = cdem::rock_strength(joint);
  for (const double p3 : {0.0, 1e6, 10e6}) {
    const double p1 = cdem::strength(joint.curve, p3), sine = cdem::tangent(joint.curve, p3).sin_friction;
    const auto stress = [&](double part) { // the middle principal stress is that of p3
      return Mat3(Vec3(-p3, -p3, -p3 - part * (p1 - p3)).asDiagonal());
    };
    const double angle = 0.25 * pi + 0.5 * std::asin(sine); // of the plane's normal off the largest pressure
    const Vec3 normal(std::sin(angle), 0, std::cos(angle));
    CHECK_FALSE(cdem::critical_plane(stress(0.999), rock, normal));
    const auto plane = cdem::critical_plane(stress(1.001), rock, normal);
    REQUIRE(plane);
    CHECK(plane->normal.dot(normal) > 0.9999);
    CHECK(plane->mode == cdem::BondMode::broken_shear);
    CHECK(cdem::strength_utilisation(stress(1), rock) == Approx(1));
    // The bounds of kernels are convex and see it.
    bool seen = false;
    const Mat3 s = stress(1.001);
    const double components[6] = {s(0, 0), s(1, 1), s(2, 2), 0, 0, 0};
    for (const cdem::UtilisationBound& bound : cdem::utilisation_bounds(rock, 1))
      seen = seen || bound.beyond(components) > 0;
    CHECK(seen);
  }
}

TEST_CASE("Hoek-Brown: a joint is judged by the envelope of the Mohr circles at the pressure on its plane",
          "[hoek_brown]") {
  cdem::Joint joint;
  joint.curve = cdem::hoek_brown(average);
  joint.tensile_strength = cdem::uniaxial_tensile_strength(joint.curve);
  const cdem::RockStrength rock = cdem::rock_strength(joint);
  for (const double pressure : {0.0, 0.5e6, 3e6, 20e6}) {
    double shear = 0; // of the highest circle over this pressure
    for (double p3 = -joint.tensile_strength; p3 <= pressure; p3 += 1e3) {
      const double p1 = cdem::strength(joint.curve, p3);
      shear = std::max(shear, std::sqrt(std::max(0.0, (p1 - pressure) * (pressure - p3))));
    }
    const auto stress = [&](double part) {
      return symmetric(0, 0, -pressure, 0, 0, part * shear); // on the plane z
    };
    CHECK(cdem::strength_utilisation(stress(1), rock, Vec3::UnitZ(), cdem::FacePlane::own) ==
          Approx(1).epsilon(1e-4));
    CHECK_FALSE(cdem::critical_plane(stress(0.999), rock, Vec3::UnitZ(), cdem::FacePlane::own));
    const auto plane = cdem::critical_plane(stress(1.3), rock, Vec3::UnitZ(), cdem::FacePlane::own);
    REQUIRE(plane); // the traction is brought back to the envelope
    CHECK(plane->traction.z() == Approx(-pressure).margin(1));
    CHECK(plane->traction.x() == Approx(shear).epsilon(1e-4));
  }
}

TEST_CASE("Hoek-Brown: a cohesive prism cracks under sigma_3 + sigma_ci (m_b sigma_3 / sigma_ci + s)^a",
          "[hoek_brown][cohesive]") {
  const double lateral = GENERATE(0.0, 2e6);
  cdem::BodySpec prism =
      concrete_body(geom::box_mesh({0.1, 0.1, 0.2}, {2, 2, 4}, 0.1), cdem::Softening::none);
  prism.joint.curve = cdem::hoek_brown(average);
  prism.joint.tensile_strength = cdem::uniaxial_tensile_strength(prism.joint.curve);
  const double strength = cdem::strength(prism.joint.curve, lateral);
  System s(build({prism}));
  for (const char* const axis : {"x", "y", "z"})
    s.hold(cdem::Selection::side(std::string(axis) + "-"), axis);
  const auto broken_at = [&](double part) {
    s.conditions.tractions = {traction(cdem::Selection::side("x+"), {-lateral, 0, 0}),
                              traction(cdem::Selection::side("y+"), {0, -lateral, 0}),
                              traction(cdem::Selection::side("z+"), {0, 0, -part * strength})};
    cdem::RelaxOptions options;
    options.residual = 1e-4;
    options.max_steps = 3000;
    cdem::relax(s.next_stage(), options, "relax");
    return s.log.broken_shear + s.log.broken_tension;
  };
  for (const double part : {0.4, 0.7, 0.9, 0.98}) // a load put on at once overshoots
    CHECK(broken_at(part) == 0);
  CHECK(broken_at(1.02) > 0);
}

TEST_CASE("Hoek-Brown: wrong input is refused", "[hoek_brown][input]") {
  const auto refused = [](const cdem::RockMass& rock, const char* says) {
    CHECK_THROWS_WITH(cdem::validate(rock), Catch::Contains(says));
  };
  refused({0, 50, 10, 0}, "sigma_ci");
  refused({30e6, 3, 10, 0}, "gsi = 3: must be in [5, 100]");
  refused({30e6, 50, 0, 0}, "m_i");
  refused({30e6, 50, 10, 1.2}, "disturbance");
  cdem::Plasticity law = rock_mass(60, 0.01); // stronger than the peak
  CHECK_THROWS_WITH(cdem::validate(law), Catch::Contains("residual"));
  law = rock_mass(50, 0);
  law.tensile_strength *= 1.1;
  CHECK_THROWS_WITH(cdem::validate(law), Catch::Contains("tensile_strength"));
  CHECK_THROWS_WITH(cdem::reduced(law, 2), Catch::Contains("Hoek-Brown"));
  cdem::Joint joint = concrete_joint(cdem::Softening::linear);
  joint.curve = cdem::hoek_brown(average);
  joint.tensile_strength = 0.05e6;
  CHECK_THROWS_WITH(cdem::validate(joint), Catch::Contains("its faces are brittle"));
  joint.softening = cdem::Softening::none;
  joint.fracture_energy_1 = joint.fracture_energy_2 = 0;
  cdem::validate(joint);
  CHECK_THROWS_WITH(build({body("blocks", geom::grid({1, 1, 1}, {2, 1, 1}), rock(), joint)}),
                    Catch::Contains("cohesive"));
}
