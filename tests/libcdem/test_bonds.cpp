// Bonds and contacts between two rigid halves of a shear box: the upper half is led along a given path, the
// force on it is that of the interface alone.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double joint_area = 0.3 * 0.2; // m2
constexpr double kn = 4e11, ks = 1.5e11; // Pa/m

cdem::Joint joint(bool bonded = true) {
  cdem::Joint j;
  j.bonded = bonded;
  j.cohesion = 2e6;
  j.friction_angle = 35 * degree;
  j.tensile_strength = 1.5e6;
  j.normal_stiffness = kn;
  j.shear_stiffness = ks;
  return j;
}

class ShearBox {
public:
  explicit ShearBox(const cdem::Joint& j) : simulation_(spec(j), 1, nullptr) {
    cdem::Fix fix;
    fix.on = cdem::Selection::of_body("lower");
    simulation_.fix(fix);
  }

  // Leads the upper half to a displacement at which an elastic joint carries this traction, Pa; returns the
  // force of the lower half on the upper one over the area, Pa: positive z part is pressure.
  Vec3 go(const Vec3& traction) {
    cdem::Fix fix;
    fix.on = cdem::Selection::of_body("upper");
    fix.displacement = Vec3(traction.x() / ks, traction.y() / ks, traction.z() / kn);
    simulation_.fix(fix);
    REQUIRE(simulation_.relax({}).converged);
    return -simulation_.reaction(fix.on) / joint_area;
  }

  cdem::ModelCounts counts() const { return simulation_.counts(); }
  const cdem::Simulation& simulation() const { return simulation_; }

private:
  static cdem::ModelSpec spec(const cdem::Joint& j) {
    cdem::ModelSpec s;
    s.bodies = {body("lower", geom::grid({0.3, 0.2, 0.1}, {1, 1, 1})),
                body("upper", geom::grid({0.3, 0.2, 0.1}, {1, 1, 1}, {0, 0, 0.1}))};
    s.pairs = {{"lower", "upper", j}};
    return s;
  }
  cdem::Simulation simulation_;
};

} // namespace

TEST_CASE("a bond in tension carries up to T A and breaks above it", "[bonds]") {
  const double strength = joint().tensile_strength;
  ShearBox box(joint());
  CHECK(box.go({0, 0, 0.999 * strength}).z() == Approx(-0.999 * strength).epsilon(1e-9));
  CHECK(box.counts().intact == box.counts().bonds);
  CHECK(box.go({0, 0, 1.001 * strength}).norm() == 0);
  CHECK(box.counts().broken_tension == box.counts().bonds);
  for (const cdem::BreakRow& row : box.simulation().log().breaks)
    CHECK(row.normal_traction == Approx(strength).epsilon(1e-3));
}

TEST_CASE("a bond in shear carries up to (c - t_n tan phi) A and afterwards friction alone", "[bonds]") {
  const double tn = GENERATE(-8e6, -2e6, -1e5, 0.0, 1e6);
  const double tangent = std::tan(joint().friction_angle);
  const double strength = joint().cohesion - tn * tangent;
  const Vec3 along(0.6, -0.8, 0);
  ShearBox box(joint());
  const Vec3 before = box.go(0.999 * strength * along + Vec3(0, 0, tn));
  CHECK((before + 0.999 * strength * along + Vec3(0, 0, tn)).norm() < 1e-9 * strength);
  CHECK(box.counts().intact == box.counts().bonds);

  const Vec3 after = box.go(1.001 * strength * along + Vec3(0, 0, tn));
  CHECK(box.counts().broken_shear == box.counts().bonds);
  const Vec3 friction = std::max(0.0, -tn) * tangent * along;
  CHECK((after + friction + Vec3(0, 0, std::min(tn, 0.0))).norm() < 1e-9 * strength);
  for (const cdem::BreakRow& row : box.simulation().log().breaks)
    CHECK(row.shear_traction == Approx(strength).epsilon(1e-3));
}

TEST_CASE("where tension alone has used up the shear strength any shear breaks the bond", "[bonds]") {
  cdem::Joint weak = joint();
  weak.cohesion = 0.5e6; // c - t_n tan(phi) < 0 at 1 MPa
  ShearBox box(weak);
  box.go({0, 0, 1e6});
  CHECK(box.counts().intact == box.counts().bonds);
  box.go({10, 0, 1e6});
  CHECK(box.counts().broken_shear == box.counts().bonds);
}

TEST_CASE("a broken bond and a contact that never was bonded give the same forces", "[bonds]") {
  ShearBox broken(joint()), never(joint(false));
  const Vec3 path[] = {{0, 0, 2e6},        {0, 0, 1e5},        {1e6, 0, -1e6},       {3e6, 1e6, -2e6},
                       {-2e6, 4e6, -1e6},  {-2e6, 4e6, -5e6},  {0, 0, -5e6},         {1e6, 1e6, 1e6},
                       {2e6, 1e6, -3e6},   {2.5e6, 1e6, -3e6}, {-9e6, -9e6, -0.1e6}, {-8e6, -9e6, -10e6},
                       {-8e6, -9e6, -1e-3}};
  for (const Vec3& traction : path) {
    const Vec3 a = broken.go(traction), b = never.go(traction);
    INFO("at " << traction.transpose() << ": " << a.transpose() << " against " << b.transpose());
    CHECK((a - b).norm() <= 1e-12 * 1e6);
  }
  CHECK(broken.counts().broken_tension == broken.counts().bonds);
  CHECK(never.counts().contacts == never.counts().bonds);
}

TEST_CASE("bonds that may not break carry any traction", "[bonds]") {
  cdem::Fix fix;
  cdem::Simulation s = simulation(geom::grid({0.3, 0.2, 0.2}, {1, 1, 2}), rock(), joint());
  fix.on = cdem::Selection::in_box({{-1, -1, -1}, {1, 1, 0.09}});
  s.fix(fix);
  fix.on = cdem::Selection::in_box({{-1, -1, 0.11}, {1, 1, 1}});
  fix.displacement = Vec3(0, 0, 1e-4);
  s.fix(fix);
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  CHECK(s.counts().intact == s.counts().bonds);
  CHECK(s.max("stress.zz").value > 5 * joint().tensile_strength);
}
