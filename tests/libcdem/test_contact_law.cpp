// The law of one contact: numbers in, numbers out.
#include "libcdem/contact/response/contact_law.hpp"

#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using cdem::Contact;
using cdem::ContactLaw;
using cdem::ContactMotion;
using geom::Vec3;

namespace {

const ContactLaw law{1e8, 5e7, 0.5};

ContactMotion motion(double depth, const Vec3& slid = Vec3::Zero(), const Vec3& normal = Vec3::UnitZ()) {
  ContactMotion m;
  m.normal = normal;
  m.depth = depth;
  m.slid = slid;
  return m;
}

Contact pressed(double depth) {
  Contact c;
  c.normal = Vec3::UnitZ();
  advance(c, law, motion(depth));
  return c;
}

} // namespace

TEST_CASE("contact law: kn d presses, nothing pulls", "[contact][law]") {
  CHECK(pressed(1e-4).effective_penetration() == Approx(1e-4));
  Contact c = pressed(1e-4);
  advance(c, law, motion(-1e-5));
  CHECK(c.effective_penetration() == 0);
}

TEST_CASE("contact law: it sticks by ks and slips at tan(phi), and friction takes what the slip costs",
          "[contact][law]") {
  Contact c = pressed(1e-4); // may carry 5 kN
  CHECK(advance(c, law, motion(1e-4, {4e-5, 0, 0})).friction == 0);
  CHECK(c.shear.x() == Approx(-2e3));
  // 2 kN to 5 kN over 60 micrometres, then 40 more at 5 kN.
  double taken = 0;
  for (int i = 0; i < 1000; ++i)
    taken += advance(c, law, motion(1e-4, {1e-7, 0, 0})).friction;
  CHECK(c.shear.x() == Approx(-5e3));
  CHECK(taken == Approx(5e3 * 4e-5).epsilon(1e-3));
}

TEST_CASE("contact law: unloading a slipping contact gives back what its shear stored, as friction",
          "[contact][law]") {
  Contact c = pressed(1e-4);
  advance(c, law, motion(1e-4, {1e-4, 0, 0})); // at its limit, 5 kN
  CHECK(c.shear.norm() == Approx(5e3));
  const double stored = 0.5 * 5e3 * 5e3 / law.ks;
  CHECK(advance(c, law, motion(-1e-6)).friction == Approx(stored));
  CHECK(c.shear.norm() == 0);
}

TEST_CASE("contact law: shear turns with the normal and keeps its size", "[contact][law]") {
  Contact c = pressed(1e-4);
  advance(c, law, motion(1e-4, {2e-5, 3e-5, 0}));
  const double size = c.shear.norm();
  Vec3 normal = Vec3::UnitZ();
  for (int i = 1; i <= 90; ++i) {
    normal = testing::rotation(Vec3::UnitY(), i * testing::degree) * Vec3::UnitZ();
    advance(c, law, motion(1e-4, Vec3::Zero(), normal));
    CHECK(std::abs(c.shear.dot(normal)) < 1e-10 * size);
    CHECK(c.shear.norm() == Approx(size).epsilon(1e-12));
  }
  CHECK(normal.x() == Approx(1));
  CHECK(c.shear.y() == Approx(-1.5e3)); // across the axis' plane nothing turned it
}

TEST_CASE("contact law: an overlap that was found starts without force, one that was entered does not",
          "[contact][law]") {
  CHECK(first_reference_penetration(motion(1e-4)) == 1e-4);
  CHECK(first_reference_penetration(motion(1e-4, {0, 0, -1e-4})) == 0); // it came that far in this step
  Contact c;
  c.normal = Vec3::UnitZ();
  c.reference_penetration = 1e-4;
  advance(c, law, motion(1e-4));
  CHECK(c.effective_penetration() == 0);
  advance(c, law, motion(1.5e-4));
  CHECK(c.effective_penetration() == Approx(5e-5));
  advance(c, law, motion(2e-5)); // it backs out and comes again: now from there
  CHECK(c.effective_penetration() == 0);
  advance(c, law, motion(1e-4));
  CHECK(c.effective_penetration() == Approx(8e-5));
}

TEST_CASE("contact law: what is stored under a face is lost where another is suddenly nearer",
          "[contact][law]") {
  const Contact c = pressed(3e-4);
  const Vec3 deeper(0, 0, -1e-5); // in the step
  // The other face was as near before the step: nothing jumps.
  CHECK(target_change_loss(c, law, motion(3.1e-4, deeper)) == Approx(0).margin(1e-9));
  CHECK(target_change_loss(c, law, motion(4e-4, deeper)) == 0);
  // It was at 2e-4, or this side of it.
  CHECK(target_change_loss(c, law, motion(2.1e-4, deeper)) == Approx(0.5 * law.kn * (9e-8 - 4e-8)));
  CHECK(target_change_loss(c, law, motion(-1e-4, deeper)) == Approx(0.5 * law.kn * 9e-8));
}

TEST_CASE(
    "contact law: work of the shear force is what is stored and what friction takes, however the slip turns",
    "[contact][law]") {
  Contact c = pressed(1e-4);
  double work = 0, taken = 0;
  int slips = 0;
  for (int i = 0; i < 200; ++i) {
    const double phase = 0.3 * i;
    const ContactMotion m = motion(1e-4 * (1.1 + std::sin(1.7 * phase)),
                                   {8e-5 * std::cos(phase), 5e-5 * std::sin(2.3 * phase), 0});
    const Vec3 before = c.shear;
    const double lost = advance(c, law, m).friction;
    work -= 0.5 * (before + c.shear).dot(m.slid);
    taken += lost;
    slips += lost > 0 ? 1 : 0;
  }
  CHECK(slips > 100);
  CHECK(work == Approx(taken + 0.5 * c.shear.squaredNorm() / law.ks).epsilon(1e-12));
}

TEST_CASE("contact law: one that opens gives back what its normal spring stored, one that goes round an edge "
          "does not",
          "[contact][law]") {
  Contact c = pressed(1e-4);
  CHECK(end_loss(c, law, {0, 0, 1.2e-4}) == 0); // opened within the step
  const double stored = 0.5 * law.kn * 1e-8;
  CHECK(end_loss(c, law, {1e-3, 0, 0}) == Approx(stored)); // off sideways
  // Half way out: the force has worked along half of its depth.
  CHECK(end_loss(c, law, {0, 0, 5e-5}) == Approx(0.5 * stored));
  // Shear: what was stored less the work of its force.
  advance(c, law, motion(1e-4, {4e-5, 0, 0}));
  const double shear = 2e3;
  CHECK(end_loss(c, law, {0, 0, 1.2e-4}) == Approx(0.5 * shear * shear / law.ks));
  CHECK(end_loss(c, law, {-1e-5, 0, 1.2e-4}) == Approx(0.5 * shear * shear / law.ks - 0.5 * shear * 1e-5));
}

TEST_CASE(
    "contact law: restitution returns e^2 of what an impact puts in, and damping never gives energy back",
    "[contact][law]") {
  const double e = 0.4, k = 1e8, deepest = 1e-4;
  const ContactLaw bouncing{0.5 * k * (1 + e * e), 5e7, 0, (1 - e * e) / (1 + e * e), true, true};
  Contact c;
  c.normal = Vec3::UnitZ();
  const auto step = [&](double depth, double approach) { // the damping, J
    ContactMotion m = motion(depth, Vec3(0, 0, c.depth - depth));
    m.approach = approach;
    m.held_at_most = 1;
    return advance(c, bouncing, m).damping;
  };
  double taken = 0;
  for (int i = 1; i <= 1000; ++i)
    taken += step(deepest * i / 1000, 1);
  const double given = 0.5 * k * deepest * deepest;
  CHECK(taken == Approx(0).margin(1e-9 * given));
  CHECK(cdem::energy(c, bouncing) == Approx(given));
  for (int i = 999; i >= 0; --i)
    taken += step(deepest * i / 1000, -1);
  CHECK(taken == Approx((1 - e * e) * given).epsilon(3e-3));
  // Waves shake the contact while its body still approaches, turns round, and comes again: what the body loses by
  // restitution may only grow.
  for (int i = 0; i < 2000; ++i) {
    const double lost =
        step(deepest * (1.2 + std::sin(0.37 * i) * std::cos(0.11 * i)), std::max(0.0, std::sin(0.05 * i)));
    CHECK(lost >= -1e-12 * given);
    taken += lost;
  }
  CHECK(taken > 2 * given);
}

TEST_CASE(
    "contact law: friction follows the mean of a force that vibrates, and in an impact the force itself",
    "[contact][law]") {
  const ContactLaw damped{1e8, 5e7, 0.5, 0.2, true, true};
  const double deep = 1e-4, rests = 0.5 * damped.kn * deep; // m; N, its friction at rest
  const auto slide = [&](Contact& c,
                         double depth) { // N, the friction after one of 300 steps of an oscillation
    ContactMotion m = motion(depth, {deep, 0, 0});
    m.omega_step = 2 * testing::pi / 300;
    m.shares_friction = true;
    advance(c, damped, m);
    return c.shear.norm();
  };
  Contact standing = pressed(deep);
  standing.at_rest = deep;
  double sum = 0;
  for (int i = 0; i < 6000; ++i) {
    const double friction = slide(standing, deep * (1 + 0.9 * std::sin(2 * testing::pi * i / 60)));
    CHECK(friction == Approx(rests).epsilon(0.1));
    sum += friction;
  }
  CHECK(sum / 6000 == Approx(rests).epsilon(0.01));
  Contact hits;
  hits.normal = Vec3::UnitZ();
  double impulse = 0, of_force = 0;
  for (int i = 1; i < 150; ++i) {
    const double depth = deep * std::sin(testing::pi * i / 150);
    impulse += slide(hits, depth);
    of_force += 0.5 * damped.kn * depth;
  }
  CHECK(impulse == Approx(of_force).epsilon(0.02));
}

TEST_CASE("contact law: a contact that bounces has the friction of its normal force in the mean",
          "[contact][law]") {
  const ContactLaw damped{1e8, 5e7, 0.5, 0.2, true, true};
  const double deep = 1e-4, height = GENERATE(0.5, 1.5, 3.0, 10.0); // m; of the oscillation, over that
  CAPTURE(height);
  Contact c;
  c.normal = Vec3::UnitZ();
  double friction = 0, of_force = 0;
  for (int i = 0; i < 60000; ++i) {
    const double depth = deep * (1 + height * std::sin(2 * testing::pi * i / 60));
    if (depth <= 0) { // open: it keeps its means
      c.shear = Vec3::Zero();
      c.depth = 0;
      c.damping = 0;
      continue;
    }
    ContactMotion m = motion(depth, {100 * deep, 0, 0});
    m.omega_step = 2 * testing::pi / 60;
    m.shares_friction = true;
    advance(c, damped, m);
    if (i < 30000)
      continue;
    friction += c.shear.norm();
    of_force += 0.5 * normal_force(c, damped);
  }
  CHECK(friction == Approx(of_force).epsilon(height < 1 ? 1e-3 : 0.035));
}

TEST_CASE("contact law: a relaxation finds a contact at rest as deep as it is", "[contact][law]") {
  Contact c = pressed(1e-4);
  c.at_rest = 3e-5;
  ContactMotion m = motion(2e-4);
  m.in_relaxation = true;
  advance(c, {1e8, 5e7, 0.5, 0.2, true, true}, m);
  CHECK(c.at_rest == c.effective_penetration());
  CHECK(c.damping == 0);
}

TEST_CASE("a spring that closes and opens within steps keeps the energy of an impact to the fourth order",
          "[contact]") {
  const double omega_step = GENERATE(0.05, 0.1, 0.2, 0.3), mass = law.kn, speed = 1; // omega = 1 / s
  for (double phase = 0.05; phase < 1; phase += 0.1) {
    CAPTURE(omega_step, phase);
    double velocity = speed, lost = 0; // of what it meets
    Contact c;
    c.normal = Vec3::UnitZ();
    for (double depth = -phase * speed * omega_step; velocity > 0 || depth > 0;) {
      const double moved = velocity * omega_step;
      depth += moved;
      if (depth <= 0)
        continue;
      ContactMotion m = motion(depth, {0, 0, -moved});
      m.part_of_step = cdem::part_of_step(depth, moved);
      lost += advance(c, law, m).friction;
      velocity -= part_borne(m) * normal_force(c, law) / mass * omega_step;
    }
    CHECK(velocity * velocity == Approx(speed * speed).epsilon(std::pow(omega_step, 4)));
    CHECK(lost == 0);
  }
}

TEST_CASE("contact law: the reference follows a jump of the depth, and no motion", "[contact][law]") {
  Contact old = pressed(3e-4);
  old.reference_penetration = 1e-4;
  const Vec3 closing(0, 0, -2e-5), sliding(5e-5, 0, 0);
  // The depth grows by the motion along the normal, or the point slides past: the same surface.
  CHECK(next_reference_penetration(old, motion(3.2e-4, closing)) == 1e-4);
  CHECK(next_reference_penetration(old, motion(3e-4, sliding)) == 1e-4);
  CHECK(next_reference_penetration(old, motion(2e-4, closing)) == 1e-4);
  // Another surface, a millimetre above: the contact is pressed more by the motion of the step alone.
  Contact now = old;
  now.reference_penetration = next_reference_penetration(old, motion(1.32e-3, closing));
  now.depth = 1.32e-3;
  CHECK(now.effective_penetration() == Approx(2.2e-4));
}
