// One point of a cracking face, led along paths: what it takes from the body, and that it never gives back more.
#include "libcdem/bond/cohesive_law.hpp"
#include "tests/libcdem/softening_joint.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace cdem;
using geom::Vec3;

namespace {

constexpr double k = 1e11;                                 // Pa/m
const Vec3 across_plane = {0, 0, 1}, along_plane{1, 0, 0}; // of the plane

struct CrackedPoint {
  SofteningLaw law;
  CohesivePoint<double> at;
  Vec3 gap = Vec3::Zero();
  double work = 0, friction = 0, breaking = 0, least_breaking = 0,
         most_beyond = 0; // J/m2, J/m2, J/m2, J/m2, 1

  // began: Pa, the traction across its plane, on the strength surface.
  CrackedPoint(const Joint& joint, const Vec3& began)
      : law(softening_law(joint, k, k, SofteningBegins::at_strength)) {
    at.plane = triple(across_plane);
    at.offset = triple(Vec3(began / k));
    at.drawn = 1;
  }

  Vec3 traction() const { return vec(now().across); }
  CohesiveResponse<double> now() const { return cohesive_response<double>(law, at, triple(gap), 0); }
  double stored() const { return stored_across<double>(law, at, now()); }

  void step(const Vec3& to) {
    const Vec3 before = traction();
    const CohesiveResponse<double> r = cohesive_response<double>(law, at, triple(to), -1);
    const SofteningLoss<double> loss = cohesive_loss<double>(law, at, triple(gap), triple(to), r);
    work += 0.5 * (before + vec(r.across)).dot(to - gap);
    friction += loss.friction;
    breaking += loss.breaking;
    // A step in which it opens or closes has its kink between the points of the trapezoidal rule.
    least_breaking = std::min(least_breaking, loss.breaking + 0.5 * k * (to - gap).squaredNorm());
    at.damage = r.damage;
    at.drawn = r.drawn;
    at.slip = r.slip;
    gap = to;
    const Vec3 t = vec(r.across);
    const double tn = t.dot(across_plane), ts = (t - tn * across_plane).norm();
    most_beyond = std::max({most_beyond, tn / law.tensile_strength - 1,
                            cohesive_load(ts, law.tan_friction, tn) / law.cohesion - 1});
  }

  void go(const Vec3& to, int steps) {
    const Vec3 from = gap;
    for (int i = 1; i <= steps; ++i)
      step(from + (to - from) * i / steps);
  }
};

} // namespace

TEST_CASE("cohesive law: opening and slip under pressure take the fracture energies", "[cohesive][law]") {
  const Softening curve = GENERATE(Softening::linear, Softening::exponential);
  const Joint joint = testing::softening_joint(curve);
  const double tangent = std::tan(joint.friction_angle), pressure = 2e6;
  SECTION("opening") {
    CrackedPoint point(joint, joint.tensile_strength * across_plane);
    point.go(1.01 * point.law.opening * across_plane, 4000);
    CHECK(point.breaking == Approx(joint.fracture_energy_1).epsilon(2e-3));
    CHECK(point.stored() == Approx(0).margin(1e-12));
    CHECK(point.traction().norm() == 0);
  }
  SECTION("slip") {
    CrackedPoint point(joint, (joint.cohesion + pressure * tangent) * along_plane - pressure * across_plane);
    const double way = 1.01 * point.law.slip;
    point.go(way * along_plane, 4000);
    // The energy that its contact stores now was never given to it.
    CHECK(point.breaking + point.stored() == Approx(joint.fracture_energy_2).epsilon(3e-3));
    CHECK(point.friction == Approx(pressure * tangent * way).epsilon(3e-3));
    CHECK((point.traction() - (pressure * tangent * along_plane - pressure * across_plane)).norm() <
          1e-6 * pressure);
  }
  SECTION("in few large steps too") {
    CrackedPoint point(joint, joint.tensile_strength * across_plane);
    point.go(1.01 * point.law.opening * across_plane, 7);
    CHECK(point.at.damage == 1);
    CHECK(point.most_beyond < 0.05);
  }
}

TEST_CASE("cohesive law: a crack that closes has no traction at its origin", "[cohesive][law]") {
  const Joint joint = testing::softening_joint(Softening::linear);
  const bool opens = GENERATE(true, false);
  const double strength = opens ? joint.tensile_strength : joint.cohesion;
  const Vec3 along = opens ? across_plane : along_plane;
  const double stretch = strength / k,
               part = GENERATE(0.6, 2.0, 5.0); // of the stretch with which the law began
  CrackedPoint point(joint, strength * along);
  point.go(part * stretch * along, 400);
  const double taken = point.work, carried = point.traction().dot(along);
  INFO("damage " << point.at.damage << ", drawn " << point.at.drawn);
  CHECK(carried ==
        Approx(strength * (1 - part * stretch / (opens ? point.law.opening : point.law.slip))).epsilon(1e-3));
  const double damage = point.at.damage;
  point.go(Vec3::Zero(), 400);
  CHECK(point.at.damage == damage);
  CHECK(point.traction().dot(along) >= 0);
  CHECK(point.traction().dot(along) < (part < 1 ? 0.5 : part < 5 ? 0.05 : 1e-3) * strength);
  CHECK(point.work >
        (part < 1 ? 0 : 0.45 * taken)); // what it gives back is at most what it would on a line to the origin
  point.go(part * stretch * along, 400);
  CHECK(point.traction().dot(along) == Approx(carried).epsilon(1e-9));
  CHECK(point.work == Approx(taken).epsilon(1e-6));
}

TEST_CASE("cohesive law: on any path the traction stays on the strength and damage only takes",
          "[cohesive][law]") {
  const int seed = GENERATE(range(1, 41));
  std::mt19937 draw(seed);
  const auto uniform = [&] { return std::uniform_real_distribution<double>()(draw); };
  const Joint joint = testing::softening_joint(seed % 2 == 0 ? Softening::linear : Softening::exponential);
  const double tangent = std::tan(joint.friction_angle), pressure = seed % 4 < 2 ? 5e5 * uniform() : 0;
  const Vec3 began =
      pressure > 0
          ? Vec3((joint.cohesion + pressure * tangent) * along_plane - pressure * across_plane)
          : Vec3(joint.tensile_strength * across_plane +
                 0.9 * uniform() * (joint.cohesion - joint.tensile_strength * tangent) * along_plane);
  CrackedPoint point(joint, began);
  const double reach = 3 * joint.tensile_strength / k;
  for (int leg = 0; leg < 40; ++leg) {
    const Vec3 to =
        reach * (1 + 0.1 * leg) * Vec3(2 * uniform() - 1, 2 * uniform() - 1, 1.6 * uniform() - 0.6);
    const double breaking = point.breaking, damage = point.at.damage;
    point.go(to, 200);
    INFO("seed " << seed << ", leg " << leg << ", damage " << damage << " to " << point.at.damage
                 << ", drawn " << point.at.drawn << ", pressure " << pressure << ", to "
                 << to.transpose() * k / joint.tensile_strength);
    CHECK(point.at.damage >= damage);
    // A crack that began in shear and goes on in tension has stored more than that takes.
    CHECK(point.breaking > breaking - 1e-2 * joint.fracture_energy_1);
    if (point.at.damage == damage)
      CHECK(point.breaking == Approx(breaking).margin(1e-3 * joint.fracture_energy_1));
    const double began_with = 0.5 * began.squaredNorm() / k, drawn = point.at.drawn;
    CHECK(point.stored() >=
          -1.01 * (pressure > 0 ? 1 : (1 - point.at.damage) * drawn * drawn) * began_with - 1e-9);
  }
  CHECK(point.most_beyond < 0.02);
  CHECK(point.work == Approx(point.stored() + point.breaking + point.friction).margin(1e-9));
}
