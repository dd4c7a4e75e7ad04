// Laws of the softening bond: its energies, its irreversibility, its friction. Reference values are the
// closed forms of joint/softening.hpp's opening comment, integrated by hand.
#include "libcdem/joint/softening.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "tests/libcdem/softening_joint.hpp"

#include <catch2/catch.hpp>

using namespace cdem;
using geom::Vec3;
using testing::pi;
using testing::softening_joint;

namespace {

const Vec3 across = Vec3(1, 2, -2) / 3.0, along = Vec3(2, 1, 2) / 3.0;

// One spring led along a path, with the work done on it and what it lost.
struct Walker {
  SofteningLaw law;
  Vec3 stretch = Vec3::Zero(), slip = Vec3::Zero(), traction = Vec3::Zero(), contact = Vec3::Zero();
  double damage = 0, work = 0, friction = 0, breaking = 0, least_breaking = 0, peak_shear = 0;
  BondMode mode = BondMode::intact;

  explicit Walker(const SofteningLaw& l) : law(l) {}

  void step(const Vec3& to) {
    const SofteningResponse<double> r = softening_response<double>(law, triple(across), triple(to), damage,
                                                                   triple(slip), mode == BondMode::intact);
    const SofteningLoss<double> loss =
        softening_loss<double>(law, triple(across), triple(stretch), damage, triple(slip), triple(to), r);
    work += 0.5 * (traction + vec(r.traction)).dot(to - stretch);
    friction += loss.friction;
    breaking += loss.breaking;
    // A step in which the bond opens or closes has its kink between the points of the trapezoidal rule.
    const double kink = 0.5 * law.kn * (to - stretch).squaredNorm();
    least_breaking = std::min(least_breaking, loss.breaking + kink);
    damage = r.damage;
    if (damage > 0)
      slip = vec(r.slip);
    if (r.separated)
      mode = mode_of(r);
    traction = vec(r.traction);
    contact = vec(r.contact);
    peak_shear = std::max(peak_shear, (traction - traction.dot(across) * across).norm());
    stretch = to;
  }

  void go(const Vec3& to, int steps) {
    const Vec3 from = stretch;
    for (int i = 1; i <= steps; ++i)
      step(from + (to - from) * i / steps);
  }

  double stored() const {
    return softening_stored<double>(law, triple(across), triple(stretch), damage, triple(contact));
  }
};

Softening any_curve() {
  return GENERATE(Softening::linear, Softening::exponential);
}

} // namespace

TEST_CASE("opening a bond to separation takes G_I, whatever its stiffness") {
  const Joint j = softening_joint(any_curve());
  const double kn = GENERATE(2e10, 1e12, 1e14);
  Walker w(softening_law(j, kn, 0.4 * kn));
  w.go(2 * (w.law.opening + j.tensile_strength / kn) * across, 20000);
  CHECK(w.mode == BondMode::broken_tension);
  CHECK(w.work == Approx(j.fracture_energy_1).epsilon(1e-3));
  CHECK(w.breaking == Approx(j.fracture_energy_1).epsilon(1e-3));
  CHECK(w.friction == 0);
  CHECK(w.traction.norm() == 0);
}

TEST_CASE(
    "slip under constant pressure takes G_II and the work of friction, from a strength of c0 + p tan(phi)") {
  const Joint j = softening_joint(any_curve());
  const double ks = GENERATE(2e10, 1e12);
  const double p = GENERATE(0.0, 1e6, 2e7);
  const double kn = 2.5 * ks, friction = p * std::tan(j.friction_angle);
  Walker w(softening_law(j, kn, ks));
  const Vec3 pressed = -p / kn * across;
  w.step(pressed);
  const double end = (friction + j.cohesion) / ks + 1.5 * w.law.slip;
  w.work = 0;
  w.go(pressed + end * along, 40000);
  CHECK(w.mode == BondMode::broken_shear);
  CHECK(w.peak_shear == Approx(j.cohesion + friction).epsilon(1e-3));
  CHECK(w.breaking == Approx(j.fracture_energy_2).epsilon(1e-3));
  CHECK(w.friction ==
        Approx(friction * (end - friction / ks)).epsilon(2e-3).margin(1e-6)); // slip beyond the elastic
  const double rubbing = friction * friction / (2 * ks) + friction * (end - friction / ks);
  CHECK(w.work == Approx(j.fracture_energy_2 + rubbing).epsilon(1e-3));
  CHECK((w.traction - (-p * across + friction * along)).norm() <= 1e-6 * j.cohesion);
}

TEST_CASE("separation at a fixed ratio of opening to slip takes t0.e0/2 + S t0.d / |d/w|") {
  const Joint j = softening_joint(any_curve());
  const double kn = 1e12, ks = 4e11, angle = GENERATE(5, 20, 45, 60, 80) * pi / 180;
  Walker w(softening_law(j, kn, ks));
  const double dn = std::cos(angle), ds = std::sin(angle);
  w.go((w.law.opening + w.law.slip) * (dn * across + ds * along), 40000);

  const double area = j.softening == Softening::linear ? 0.5 : 0.2 - 1 / (std::exp(5.0) - 1);
  const double w1 = (50 - 1e12 / (2 * kn)) / (1e6 * area), w2 = (200 - 4e12 / (2 * ks)) / (2e6 * area);
  // The ray meets the tension cut-off or the cone, whichever is nearer.
  const double e0 = std::min(1e6 / (kn * dn), 2e6 / (ks * ds + kn * dn * std::tan(j.friction_angle)));
  const double t0_d = e0 * (kn * dn * dn + ks * ds * ds);
  const double energy = 0.5 * t0_d * e0 + area * t0_d / std::hypot(dn / w1, ds / w2);
  CHECK(w.work == Approx(energy).epsilon(1e-3));
  CHECK(w.breaking == Approx(energy).epsilon(1e-3));
  CHECK(w.mode == (dn / w1 > ds / w2 ? BondMode::broken_tension : BondMode::broken_shear));
}

TEST_CASE("the traction stays on the shrinking strength surface while damage grows") {
  const Joint j = softening_joint(any_curve());
  const double kn = 1e12, ks = 4e11, p = 3e6;
  Walker w(softening_law(j, kn, ks));
  const Vec3 pressed = -p / kn * across;
  w.step(pressed);
  const double part = GENERATE(0.1, 0.5, 0.9);
  const double elastic = (j.cohesion + p * std::tan(j.friction_angle)) / ks;
  w.go(pressed + (elastic + part * w.law.slip) * along, 5000);
  const double left = j.softening == Softening::linear
                          ? 1 - part
                          : (std::exp(-5 * part) - std::exp(-5.0)) / (1 - std::exp(-5.0));
  CHECK(w.traction.dot(along) == Approx(left * j.cohesion + p * std::tan(j.friction_angle)).epsilon(1e-9));
  CHECK(w.traction.dot(across) == Approx(-p).epsilon(1e-12));
}

TEST_CASE("a damaged bond unloads to the origin along its secant and loses nothing on the way") {
  const Joint j = softening_joint(any_curve());
  Walker w(softening_law(j, 1e12, 4e11));
  const Vec3 far = 0.3 * w.law.opening * across + 0.2 * w.law.opening * along;
  w.go(far, 4000);
  REQUIRE(w.damage > 0.3);
  REQUIRE(w.damage < 1);
  const double damage = w.damage, breaking = w.breaking;
  const Vec3 traction = w.traction;
  w.go(0.5 * far, 7);
  CHECK((w.traction - 0.5 * traction).norm() <= 1e-9 * traction.norm());
  w.go(Vec3::Zero(), 7);
  CHECK(w.traction.norm() <= 1e-9 * traction.norm());
  w.go(far, 13);
  CHECK((w.traction - traction).norm() <= 1e-9 * traction.norm());
  CHECK(w.damage == Approx(damage).epsilon(1e-12));
  CHECK(w.breaking == Approx(breaking).epsilon(1e-9));
  w.go(4 * w.law.opening * across, 1000);
  CHECK(w.mode == BondMode::broken_tension);
}

TEST_CASE("a damaged bond is as stiff as a whole one when it is pressed") {
  const Joint j = softening_joint(any_curve());
  Walker w(softening_law(j, 1e12, 4e11));
  w.go(0.5 * w.law.opening * across, 1000);
  REQUIRE(w.damage > 0.3);
  w.go(-5e-6 * across, 100);
  CHECK((w.traction + 5e6 * across).norm() <= 1e-6 * 5e6);
}

TEST_CASE("sliding a damaged bond to and fro dissipates by friction alone, in its damaged part") {
  const Joint j = softening_joint(any_curve());
  const double kn = 1e12, ks = 4e11, p = 1e6, limit = p * std::tan(j.friction_angle);
  Walker w(softening_law(j, kn, ks));
  const Vec3 pressed = -p / kn * across;
  w.step(pressed);
  const double far = (j.cohesion + limit) / ks + 0.4 * w.law.slip;
  w.go(pressed + far * along, 4000);
  const double damage = w.damage, breaking = w.breaking, friction = w.friction;
  REQUIRE(damage > 0.3);
  REQUIRE(damage < 1);
  w.go(pressed - 0.5 * far * along, 3000);
  w.go(pressed + far * along, 3000);
  CHECK(w.damage == Approx(damage).epsilon(1e-12));
  CHECK(w.breaking == Approx(breaking).epsilon(1e-9));
  // Each way the rubbing part slips the whole way but for turning its shear round, 2 limit / ks.
  CHECK(w.friction - friction == Approx(damage * limit * 2 * (1.5 * far - 2 * limit / ks)).epsilon(2e-3));
}

TEST_CASE("damage never heals and never gives energy, on random paths, the books balance") {
  const Joint j = softening_joint(any_curve());
  const int seed = GENERATE(range(1, 9));
  Walker w(softening_law(j, 1e12, 4e11));
  double damage = 0;
  for (int leg = 0; leg < 12; ++leg) {
    const auto draw = [&](int k) { return geom::uniform(seed, leg, k); };
    const double turn = 2 * pi * draw(2);
    const Vec3 other = across.cross(along);
    w.go(w.law.opening * (0.6 * draw(0) - 0.1) * across +
             0.3 * w.law.slip * draw(1) * (std::cos(turn) * along + std::sin(turn) * other),
         4000);
    CHECK(w.damage >= damage);
    damage = w.damage;
  }
  REQUIRE(damage > 0);
  CHECK(w.friction >= 0);
  CHECK(w.least_breaking >= -1e-12 * j.fracture_energy_1);
  CHECK(w.work == Approx(w.stored() + w.friction + w.breaking).epsilon(1e-9));
}

TEST_CASE("with the least fracture energy a bond breaks at its strength like a brittle one") {
  Joint j = softening_joint(any_curve());
  const double kn = 1e12, ks = 4e11;
  j.fracture_energy_1 = 1e12 / (2 * kn);
  j.fracture_energy_2 = 4e12 / (2 * ks);
  validate(j, kn, ks);
  Walker opened(softening_law(j, kn, ks)), sheared(softening_law(j, kn, ks));
  opened.step(0.999999 * 1e6 / kn * across);
  CHECK(opened.damage == 0);
  opened.step(1.000001 * 1e6 / kn * across);
  CHECK(opened.mode == BondMode::broken_tension);
  sheared.step(0.999999 * 2e6 / ks * along);
  CHECK(sheared.damage == 0);
  sheared.step(1.000001 * 2e6 / ks * along);
  CHECK(sheared.mode == BondMode::broken_shear);
}

TEST_CASE("the strength surface of a softening bond is that of a brittle one") {
  const Joint j = softening_joint(any_curve());
  const SofteningLaw law = softening_law(j, 1e12, 4e11);
  for (int i = 0; i < 2000; ++i) {
    const double tn = -8e6 + 1e7 * geom::uniform(7, i, 0), ts = 8e6 * geom::uniform(7, i, 1);
    const bool brittle =
        breaks({law.cohesion, law.tan_friction, law.tensile_strength}, tn, ts) != BondMode::intact;
    CHECK((damage_drive<double>(law, tn / law.kn, ts / law.ks).damage > 0) == brittle);
  }
}

TEST_CASE("the law is the same for one bond and for several side by side, to the last bit") {
  using cdem::simd::Quad;
  SofteningLawOf<Quad> laws;
  std::array<SofteningLaw, 4> single;
  for (int lane = 0; lane < 4; ++lane) {
    Joint j = softening_joint(lane % 2 == 0 ? Softening::linear : Softening::exponential);
    j.friction_angle = 0.15 * (lane + 1);
    const SofteningLaw& law = single[lane] = softening_law(j, 1e12 * (lane + 1), 4e11);
    laws.softens[lane] = -1;
    laws.exponential[lane] = law.exponential ? -1 : 0;
    laws.kn[lane] = law.kn;
    laws.ks[lane] = law.ks;
    laws.cohesion[lane] = law.cohesion;
    laws.tan_friction[lane] = law.tan_friction;
    laws.tensile_strength[lane] = law.tensile_strength;
    laws.opening[lane] = law.opening;
    laws.slip[lane] = law.slip;
  }
  const auto lane_of = [](const Triple<Quad>& v, int lane) { return Vec3(v.x[lane], v.y[lane], v.z[lane]); };
  int grew = 0, separated = 0, closed = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto draw = [&](int k) { return 2 * geom::uniform(11, i, k) - 1; };
    Triple<Quad> normal, from, to, slip;
    Quad damage;
    for (int lane = 0; lane < 4; ++lane) {
      const Vec3 n = Vec3(draw(20 * lane), draw(20 * lane + 1), 1.5).normalized();
      const double scale = single[lane].opening * std::pow(10.0, 2 * draw(20 * lane + 2) - 1);
      const auto set_lane = [&](Triple<Quad>& v, const Vec3& x) {
        v.x[lane] = x.x();
        v.y[lane] = x.y();
        v.z[lane] = x.z();
      };
      const auto drawn = [&](int k) {
        return Vec3(scale * Vec3(draw(20 * lane + k), draw(20 * lane + k + 1), draw(20 * lane + k + 2)));
      };
      set_lane(normal, n);
      set_lane(from, drawn(3));
      set_lane(to, drawn(6));
      set_lane(slip, drawn(9));
      damage[lane] = std::max(0.0, draw(20 * lane + 12));
    }
    const simd::MaskOf<Quad> grows = simd::MaskOf<Quad>{} - 1;
    const auto r = softening_response<Quad>(laws, normal, to, damage, slip, grows);
    const auto lost = softening_loss<Quad>(laws, normal, from, damage, slip, to, r);
    const Quad share = shear_share<Quad>(laws, normal, to);
    for (int lane = 0; lane < 4; ++lane) {
      const Triple<double> n = triple(lane_of(normal, lane)), x = triple(lane_of(to, lane)),
                           x0 = triple(lane_of(from, lane)), s = triple(lane_of(slip, lane));
      const auto one = softening_response<double>(single[lane], n, x, damage[lane], s, true);
      const auto loss = softening_loss<double>(single[lane], n, x0, damage[lane], s, x, one);
      CHECK(lane_of(r.traction, lane) == vec(one.traction));
      CHECK(lane_of(r.slip, lane) == vec(one.slip));
      CHECK(r.damage[lane] == one.damage);
      CHECK((r.separated[lane] != 0) == one.separated);
      CHECK(lost.friction[lane] == loss.friction);
      CHECK(lost.breaking[lane] == loss.breaking);
      CHECK(share[lane] == shear_share<double>(single[lane], n, x));
      grew += one.damage > damage[lane] ? 1 : 0;
      separated += one.separated ? 1 : 0;
      closed += dot(x, n) < 0 ? 1 : 0;
    }
  }
  CHECK(grew > 1000);
  CHECK(separated > 100);
  CHECK(closed > 1000);
}

TEST_CASE("exp of several numbers has the bits of exp of one") {
  for (int i = 0; i < 4000; ++i) {
    simd::Oct x;
    for (int lane = 0; lane < lanes; ++lane)
      x[lane] = (i % 2 == 0 ? 5 : 600) * (2 * geom::uniform(3, i, lane) - 1);
    const simd::Oct y = exp_of(x);
    for (int lane = 0; lane < lanes; ++lane)
      CHECK(y[lane] == geom::portable::exp(x[lane]));
  }
}

TEST_CASE("a joint's softening is refused with the field, the value, the range and a way out") {
  using Catch::Matchers::Contains;
  Joint j = softening_joint(Softening::linear);
  const auto refused = [&](const std::string& what) {
    CHECK_THROWS_WITH(validate(j, 1e12, 4e11), Contains(what));
    CHECK_THROWS_AS(validate(j, 1e12, 4e11), geom::InputError);
  };
  CHECK_NOTHROW(validate(j, 1e12, 4e11));
  j.fracture_energy_1 = 0;
  refused("fracture_energy_1 = 0: must be a finite number > 0 J/m2");
  j.fracture_energy_1 = 0.4; // sigma_t^2 / 2 kn = 0.5 J/m2
  refused("fracture_energy_1 = 0.4: must be at least 0.5 J/m2");
  j = softening_joint(Softening::linear);
  j.fracture_energy_2 = std::nan("");
  refused("fracture_energy_2 = nan");
  j.fracture_energy_2 = 4.9; // c0^2 / 2 ks = 5 J/m2
  refused("fracture_energy_2 = 4.9: must be at least 5 J/m2");
  j = softening_joint(Softening::exponential);
  j.tensile_strength = 4e6; // the cone's tip: 2e6 / tan(30) = 3.46e6
  refused("tensile_strength = 4e+06: must be at most cohesion / tan(friction_angle) = 3.4641e+06 Pa");
  j.tensile_strength = 0;
  refused("tensile_strength = 0: must be a finite number > 0 Pa with softening");
  j = softening_joint(Softening::linear);
  j.cohesion = 0;
  refused("cohesion = 0: must be a finite number > 0 Pa with softening");
  j = softening_joint(Softening::linear);
  j.bonded = false;
  refused("softening = linear: must be none for a joint that is not bonded");
  j = softening_joint(Softening::none);
  CHECK_THROWS_WITH(validate(j), Contains("fracture_energy_1 = 50: must be left out without softening"));
}

TEST_CASE("a bond is brittle unless softening is asked for") {
  CHECK(Joint{}.softening == Softening::none);
  Joint j;
  j.cohesion = 2e6;
  j.tensile_strength = 1e6;
  CHECK_NOTHROW(validate(j));
  CHECK_FALSE(softening_law(j, 1e12, 4e11).softens);
}
