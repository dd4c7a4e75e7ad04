// Residual strength and dilation of joints: the law alone.
#include "libcdem/joint/joint_law.hpp"

#include "libcdem/joint/joint.hpp"
#include "libcdem/joint/law_reduction.hpp"

#include <catch2/catch.hpp>

using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

const cdem::JointSpring spring{1e9, 0.5e9, 0.6};
const Vec3 face_normal(0, 0, 1);

// A spring that is taken along a path and keeps its books.
struct Spring {
  cdem::JointLaw law;
  Vec3 jump = Vec3::Zero(), offset = Vec3::Zero(), traction = Vec3::Zero();
  cdem::JointHistory history = {};
  double work = 0, lost = 0;

  double stored() const {
    return cdem::joint_stored(law, spring, face_normal, jump - offset, history.parted);
  }
  void go_to(const Vec3& end, int steps = 200) {
    const Vec3 start = jump;
    for (int i = 1; i <= steps; ++i) {
      const double before = stored();
      const Vec3 next = start + (end - start) * i / steps;
      const cdem::JointResponse r = cdem::joint_response(law, spring, face_normal, next, offset, history);
      const double done = 0.5 * (traction + r.traction).dot(next - jump);
      jump = next;
      offset = r.offset;
      history = r.history;
      traction = r.traction;
      work += done;
      lost += done - (stored() - before);
    }
  }
  // To this slip, the faces moved apart as far as the pressure stays.
  void slide_under(double pressure, double slip, int steps = 400) {
    const double start = jump.x();
    for (int i = 1; i <= steps; ++i) {
      const double x = start + (slip - start) * i / steps;
      for (int k = 0; k < 40; ++k) { // the opening at which the pressure is as asked for
        const cdem::JointResponse r =
            cdem::joint_response(law, spring, face_normal, {x, 0, jump.z()}, offset, history);
        const double excess = -r.traction.z() - pressure;
        if (std::abs(excess) < 1e-6 * pressure)
          break;
        jump.z() += excess / spring.kn;
      }
      go_to({x, 0, jump.z()}, 1);
    }
  }
};

cdem::ResidualStrength residual(double friction, double dilation = 0, double limit = 1) {
  cdem::ResidualStrength law;
  law.friction = friction;
  law.dilation = dilation;
  law.dilation_limit = limit;
  return law;
}

} // namespace

TEST_CASE("friction and dilation follow the pressure that friction feels, what lifts the faces acts at once",
          "[joint_law]") {
  const double unfelt = GENERATE(-3e5, 0.0, 4e5, 9e5), slip_before = GENERATE(0.0, 0.01), friction = 0.4,
               dilation = GENERATE(0.1, 0.4);
  cdem::JointHistory history;
  history.path = slip_before + 1e-6;
  history.slip = {-slip_before, 0, 0}; // the slip goes back where there was some
  history.dilation = dilation * slip_before;
  const double rises = slip_before > 0 ? -dilation : dilation;
  const cdem::JointLaw law = residual(friction, dilation);
  const cdem::JointResponse r =
      cdem::joint_response(law, spring, face_normal, {5e-3, 0, -1e-3}, Vec3::Zero(), history, {0, unfelt});
  const double pressure = -r.traction.z(), felt = std::max(0.0, pressure - unfelt),
               slip = r.history.path - history.path;
  REQUIRE(slip > 0);
  CAPTURE(unfelt, slip_before, dilation, pressure);
  CHECK(r.offset.z() == Approx(rises * slip));
  CHECK(r.traction.x() == Approx(std::max(0.0, felt * friction + unfelt * rises)).margin(1e-3));
  CHECK(r.traction.x() - pressure * rises >= -1e-6 * pressure); // what slip takes
}

TEST_CASE("friction falls to its residual with the first slip", "[joint_law]") {
  Spring s{residual(0.4)};
  s.go_to({0, 0, -1e-3}); // 1 MPa
  s.go_to({0.599e6 / spring.ks, 0, -1e-3});
  CHECK(s.traction.x() == Approx(0.599e6));
  CHECK(s.history.path == 0);
  s.go_to({0.61e6 / spring.ks, 0, -1e-3});
  CHECK(s.traction.x() == Approx(0.4e6));
  s.go_to({-0.01, 0, -1e-3});
  CHECK(s.traction.x() == Approx(-0.4e6));
}

TEST_CASE("a broken joint bears residual cohesion and friction, and pulls with the residual tension",
          "[joint_law]") {
  cdem::ResidualStrength law = residual(0.5);
  law.cohesion = 0.3e6;
  law.tension = 0.1e6;
  Spring s{law};
  s.go_to({0, 0, -1e-3});
  s.go_to({0.01, 0, -1e-3});
  CHECK(s.traction.x() == Approx(0.3e6 + 0.5e6));
  Spring pulled{law};
  pulled.go_to({0, 0, 1e-3});
  CHECK(pulled.traction.z() == Approx(0.1e6));
  CHECK(pulled.work == Approx(0.1e6 * 1e-3 - 0.5 * 0.1e6 * 0.1e6 / spring.kn).epsilon(0.02));
  pulled.go_to({0, 0, 0.5e-3});
  CHECK(pulled.traction.z() == Approx(0.05e6)); // back on the line to the origin
  pulled.go_to({0, 0, 0});
  CHECK(pulled.lost == Approx(pulled.work));
  pulled.go_to({0, 0, -1e-3});
  CHECK(pulled.traction.z() == Approx(-1e6)); // closed faces touch where they did
}

TEST_CASE("slip opens a joint at the dilation angle up to the limit, and closes it on the way back",
          "[joint_law]") {
  const double tan_psi = 0.2, limit = 5e-3;
  Spring s{residual(0.6, tan_psi, limit)};
  s.go_to({0, 0, -1e-3});
  const auto opened_from = [&](double z) { return s.jump.z() - z; };
  const double closed = s.jump.z();
  s.slide_under(1e6, 0.004 + 0.6e6 / spring.ks);
  CHECK(opened_from(closed) == Approx(tan_psi * 0.004).epsilon(1e-3));
  s.slide_under(1e6, 0.010 + 0.6e6 / spring.ks);
  CHECK(opened_from(closed) == Approx(tan_psi * limit).epsilon(1e-3));
  s.slide_under(1e6, -0.6e6 / spring.ks); // to where the faces fit
  CHECK(opened_from(closed) == Approx(0).margin(1e-6));
}

TEST_CASE("what slip takes is friction less the work of lifting", "[joint_law]") {
  const double pressure = 1e6, slip = 0.004, tan_psi = 0.2;
  Spring s{residual(0.6, tan_psi)};
  s.go_to({0, 0, -pressure / spring.kn});
  const double before = s.lost;
  s.slide_under(pressure, slip + 0.6 * pressure / spring.ks);
  CHECK(s.lost - before == Approx((0.6 - tan_psi) * pressure * slip).epsilon(1e-3));
}

TEST_CASE("held apart no wider a dilating joint presses: all of its rise is closure", "[joint_law]") {
  const double tan_psi = 0.1;
  Spring s{residual(0.6, tan_psi)};
  s.go_to({0, 0, -1e-3});
  s.go_to({0.01, 0, -1e-3});
  const double slip = s.history.path;
  CHECK(-s.traction.z() == Approx(1e6 + spring.kn * tan_psi * slip));
  CHECK(s.traction.x() == Approx(0.6 * -s.traction.z()));
  CHECK(spring.ks * (0.01 - slip) == Approx(s.traction.x()));
}

TEST_CASE("faces that slide apart ride up too, until they touch", "[joint_law]") {
  const double dilation = std::tan(0.2);
  Spring open{residual(0.5, dilation, 0.05)};
  open.go_to({0, 0, 0.01}, 1);
  open.go_to({0.03, 0, 0.01}); // 6 mm of 10
  CHECK(open.history.dilation == Approx(0.03 * dilation).epsilon(1e-9));
  CHECK(open.traction.isZero(0));
  open.go_to({0.03, 0, 0.03 * dilation - 1e-3});
  CHECK(open.traction.z() == Approx(-1e-3 * spring.kn).epsilon(1e-6));
  Spring near{residual(0.5, dilation, 0.05)};
  near.go_to({0, 0, 1e-3}, 1);
  near.go_to({0.03, 0, 1e-3}, 1);
  CHECK(near.history.dilation == Approx(1e-3).epsilon(1e-9));
  CHECK(near.traction.isZero(0));
}

TEST_CASE("residual strength that is no residual is refused", "[joint_law]") {
  cdem::Joint joint;
  joint.cohesion = 1e6;
  joint.friction_angle = 0.6;
  joint.tensile_strength = 1e5;
  const auto refusal = [&](const cdem::ResidualStrength& law) {
    joint.law = law;
    try {
      validate(joint);
    } catch (const geom::InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(refusal(residual(0.5)).empty());
  CHECK_THAT(refusal(residual(0.8)),
             Contains("residual_friction_angle = 38.6598") && Contains("[0, friction_angle]"));
  CHECK_THAT(refusal(residual(0.5, 0.55)),
             Contains("dilation_angle = 28.8108") && Contains("rises more steeply than it rubs"));
  cdem::ResidualStrength law = residual(0.5);
  law.cohesion = 2e6;
  CHECK_THAT(refusal(law), Contains("residual_cohesion = 2e+06") && Contains("at most the cohesion"));
  law.cohesion = 0;
  law.tension = 2e5;
  CHECK_THAT(refusal(law),
             Contains("residual_tensile_strength = 200000") && Contains("at most the tensile strength"));
  joint.softening = cdem::Softening::linear;
  joint.fracture_energy_1 = joint.fracture_energy_2 = 1e5;
  CHECK_THAT(refusal(residual(0.5)), Contains("softening"));
}

TEST_CASE("a reduced law bears the strength over the factor", "[joint_law]") {
  const double factor = 1.7;
  cdem::ResidualStrength law = residual(0.5, 0.4);
  law.cohesion = 1e5;
  cdem::JointTable table;
  table.shear = {{0, 1e5}, {1e6, 7e5}};
  for (const cdem::JointLaw& one : {cdem::JointLaw(law), cdem::JointLaw(table)})
    for (const double pressure : {0.0, 0.3e6, 2e6})
      CHECK(cdem::joint_strength(reduced(one, factor), spring, pressure, 1e-3) ==
            Approx(cdem::joint_strength(one, spring, pressure, 1e-3) / factor));
  CHECK(std::get<cdem::ResidualStrength>(reduced(cdem::JointLaw(law), factor)).dilation ==
        Approx(0.5 / factor));
  CHECK_FALSE(has_law(reduced(cdem::JointLaw(), factor)));
  CHECK_THROWS_WITH(reduced(cdem::JointLaw(cdem::BartonBandis()), factor), Contains("Barton-Bandis"));
}
