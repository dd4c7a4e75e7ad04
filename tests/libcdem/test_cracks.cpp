// Crack area and energy: those of the plane that parts, for every kind of bond, and the same as the ledger and the log say.
#include "libcdem/results/crack_surface.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/softening_joint.hpp"
#include "tests/libcdem/two_halves.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double slab = 0.1, height = 0.02; // m

// Two bodies of blocks on top of each other, tied by the joint.
cdem::Simulation two_slabs(const cdem::Joint& joint) {
  cdem::Joint strong;
  strong.cohesion = strong.tensile_strength = 1e12;
  cdem::ModelSpec spec;
  for (const double z : {0.0, height}) {
    cdem::BodySpec one = body(z > 0 ? "upper" : "lower",
                              geom::grid({slab, slab, height}, {2, 2, 1}, {0, 0, z}), rock(), strong);
    one.element = cdem::Element::small_strain;
    spec.bodies.push_back(one);
  }
  spec.pairs = {{"lower", "upper", joint}};
  return cdem::Simulation(spec, 1, nullptr);
}

void lead(cdem::Simulation& s, const Vec3& end, int steps) {
  s.fix(fixed(cdem::Selection::side("z-")));
  for (int i = 1; i <= steps; ++i) {
    cdem::Fix top = fixed(cdem::Selection::side("z+"));
    top.displacement = end * i / steps;
    s.fix(top);
    cdem::RelaxOptions options;
    options.residual = 1e-5;
    REQUIRE(s.relax(options).converged);
  }
}

double logged_area(const cdem::Simulation& s) {
  double sum = 0;
  for (const cdem::BreakRow& row : s.log().breaks)
    sum += row.area;
  return sum;
}

// A box of two halves with this bonding between them, led apart at a uniform strain rate.
System halves_led_apart(cdem::BondKind kind, const cdem::Joint& joint, double duration) {
  cdem::Bonding bonding = between_halves(1);
  bonding.kind = kind;
  if (bonding.is_cohesive())
    bonding.stiffness_ratio = 1;
  cdem::Elastic straight = rock();
  straight.poissons_ratio = 0;
  System s(build({meshed("box", two_halves(2), bonding, straight, joint)}));
  const double rate = 0.02;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.velocity[i] = node(rate * (s.model.node_position[i].z() - half) * Vec3::UnitZ());
  for (const char* end : {"z-", "z+"}) {
    cdem::Fix fix = fixed(cdem::Selection::side(end), "z");
    fix.velocity = Vec3(0, 0, (end[1] == '+' ? 1 : -1) * rate * half);
    s.conditions.fixes.push_back(fix);
  }
  cdem::RunOptions options;
  options.duration = duration;
  s.run(options);
  return s;
}

} // namespace

TEST_CASE("cracks: slabs pulled apart have the area of the joint and its energy, all in tension",
          "[cracks]") {
  const cdem::Joint joint = softening_joint(GENERATE(cdem::Softening::linear, cdem::Softening::exponential));
  cdem::Simulation s = two_slabs(joint);
  CHECK(s.cracks().all().area() == 0);
  lead(s, {0, 0, 6e-4}, 12);
  const cdem::CracksByBody by_body = s.cracks();
  const cdem::Cracks all = by_body.all();
  CHECK(all.tension == Approx(slab * slab));
  CHECK(all.shear == 0);
  CHECK(all.damaged == 0);
  CHECK(all.projected == Approx(all.area()));
  // The ledger also has the error of the trapezoidal rule where a damaged bond closes.
  CHECK(all.energy.tension == Approx(s.energy().breaking).epsilon(1e-3));
  CHECK(all.energy.tension == Approx(joint.fracture_energy_1 * slab * slab).epsilon(0.02));
  CHECK(std::abs(all.energy.shear) < 1e-3 * all.energy.tension);
  // The joint is of neither body.
  CHECK(by_body.between.area() == all.area());
  REQUIRE(by_body.bodies.size() == 2);
  CHECK(by_body.bodies[0].area() == 0);
  CHECK(logged_area(s) == Approx(all.broken()));
}

TEST_CASE("cracks: slabs sheared apart have their area and energy in shear", "[cracks]") {
  cdem::Joint joint = softening_joint(cdem::Softening::linear);
  joint.friction_angle = 0;
  cdem::Simulation s = two_slabs(joint);
  lead(s, {7e-4, 0, 0}, 40);
  const cdem::Cracks all = s.cracks().all();
  CHECK(all.shear == Approx(slab * slab));
  CHECK(all.tension == 0);
  CHECK(all.energy.shear == Approx(joint.fracture_energy_2 * slab * slab).epsilon(0.02));
  CHECK(std::abs(all.energy.tension) < 0.01 * all.energy.shear);
}

TEST_CASE("cracks: a joint half way to separation has an area weighted by its damage, which unloading leaves",
          "[cracks]") {
  const cdem::Joint joint = softening_joint(cdem::Softening::linear);
  cdem::Simulation s = two_slabs(joint);
  lead(s, {0, 0, 4e-5}, 8);
  const cdem::Cracks loaded = s.cracks().all();
  CHECK(loaded.broken() == 0);
  CHECK(loaded.damaged > 0.3 * slab * slab);
  CHECK(loaded.damaged < slab * slab);
  CHECK(loaded.energy.tension > 0);
  CHECK(loaded.energy.tension < joint.fracture_energy_1 * slab * slab);
  CHECK(loaded.energy.tension == Approx(s.energy().breaking).epsilon(1e-3));
  cdem::Fix top = fixed(cdem::Selection::side("z+"));
  top.displacement = Vec3::Zero();
  s.fix(top);
  s.relax({});
  // Up to what the last relaxation left.
  CHECK(s.cracks().all().damaged == Approx(loaded.damaged).epsilon(1e-9));
  CHECK(s.cracks().all().energy.tension == Approx(loaded.energy.tension).epsilon(1e-9));
}

TEST_CASE("cracks: a plane between two halves of a mesh has its section and what the ledger says",
          "[cracks][mesh]") {
  const System s = halves_led_apart(cdem::BondKind::springs, halves_joint(), 0.01);
  const cdem::CracksByBody by_body = cdem::cracks(s.model, s.state);
  const cdem::Cracks all = by_body.all();
  CHECK(all.tension == Approx(side * side));
  CHECK(all.shear == 0);
  CHECK(by_body.bodies[0].area() == all.area());
  CHECK(all.energy.tension == Approx(s.state.spent.breaking).epsilon(1e-9));
  CHECK(all.energy.tension > 0);
}

TEST_CASE("cracks: a cohesive plane has its section and its fracture energy", "[cracks][cohesive]") {
  cdem::Joint joint = halves_joint();
  joint.softening = cdem::Softening::linear;
  joint.fracture_energy_1 = 100;
  joint.fracture_energy_2 = 400;
  const System half_way = halves_led_apart(cdem::BondKind::cohesive, joint, 0.0045);
  const cdem::Cracks damaged = cdem::cracks(half_way.model, half_way.state).all();
  CHECK(damaged.broken() == 0);
  CHECK(damaged.damaged > 0.1 * side * side);
  CHECK(damaged.energy.tension > 0);
  const System s = halves_led_apart(cdem::BondKind::cohesive, joint, 0.02);
  const cdem::Cracks all = cdem::cracks(s.model, s.state).all();
  CHECK(all.tension == Approx(side * side));
  CHECK(all.damaged == 0);
  // It cracks on its own plane.
  CHECK(all.projected == Approx(all.area()).epsilon(1e-3));
  CHECK(all.energy.tension == Approx(joint.fracture_energy_1 * side * side).epsilon(0.03));
  CHECK(all.energy.shear < 0.01 * all.energy.tension);
  // The ledger has beside it what the faces stored before they cracked.
  CHECK(all.energy.tension + all.energy.shear == Approx(s.state.spent.breaking).epsilon(0.02));
}

TEST_CASE("cracks: histories sample what the state says, and only grow", "[cracks][history]") {
  const cdem::Joint joint = softening_joint(cdem::Softening::linear);
  cdem::Simulation s = two_slabs(joint);
  s.record_cracks("crack", "");
  s.record_cracks("lower", "lower");
  CHECK_THROWS_WITH(s.record_cracks("crack", ""), Catch::Contains("crack_area"));
  CHECK_THROWS_WITH(s.record_cracks("other", "nobody"), Catch::Contains("nobody"));
  lead(s, {0, 0, 6e-4}, 12);
  const auto& probes = s.log().probes;
  const std::size_t n = cdem::crack_quantities().size();
  REQUIRE(probes.size() == 2 * n);
  CHECK(probes[0].name == "crack_area");
  const auto& last = s.log().history.back().probes;
  for (std::size_t i = 0; i < n; ++i) {
    CHECK(last[i] == cdem::crack_quantity(s.cracks().all(), cdem::crack_quantities()[i]));
    CHECK(last[n + i] == 0);
  }
  double area = 0, energy = 0;
  for (const cdem::HistoryRow& row : s.log().history) {
    CHECK(row.probes[0] >= area);
    CHECK(row.probes[5] >= energy);
    area = row.probes[0];
    energy = row.probes[5];
  }
}

TEST_CASE("cracks: a saved model has its cracks and histories again", "[cracks][checkpoint]") {
  const cdem::Joint joint = softening_joint(cdem::Softening::linear);
  cdem::Simulation s = two_slabs(joint);
  s.record_cracks("crack", "lower");
  lead(s, {0, 0, 4e-5}, 8);
  cdem::Simulation again = two_slabs(joint);
  again.restore(s.save());
  CHECK(again.log().probes.size() == s.log().probes.size());
  for (const std::string& quantity : cdem::crack_quantities())
    CHECK(cdem::crack_quantity(again.cracks().all(), quantity) ==
          cdem::crack_quantity(s.cracks().all(), quantity));
  CHECK(again.cracks().all().energy.tension > 0);
  CHECK(again.log().history.back().probes == s.log().history.back().probes);
}

TEST_CASE("cracks: a notch made by hand is none", "[cracks]") {
  cdem::Simulation s = two_slabs(softening_joint(cdem::Softening::linear));
  CHECK(s.break_bonds(cdem::Selection::everything()) > 0);
  CHECK(s.cracks().all().area() == 0);
  CHECK(cdem::crack_surface(s.model(), s.state(), s.log().breaks, true, "").bonds.triangles.empty());
}

TEST_CASE("cracks: the surface has the area, the opening and the times of what broke", "[cracks][snapshot]") {
  const System s = halves_led_apart(cdem::BondKind::springs, halves_joint(), 0.01);
  const cdem::Snapshot cut = cdem::crack_surface(s.model, s.state, s.log.breaks, false, "two halves");
  const cdem::BondSnapshot& faces = cut.bonds;
  double area = 0;
  for (const geom::Triangle& t : faces.triangles)
    area +=
        0.5 * (faces.points[t[1]] - faces.points[t[0]]).cross(faces.points[t[2]] - faces.points[t[0]]).norm();
  CHECK(area == Approx(side * side));
  std::set<double> times;
  for (const cdem::BreakRow& row : s.log.breaks)
    times.insert(row.time);
  const auto& fields = faces.triangle_fields;
  REQUIRE(fields.size() == 6);
  for (std::size_t i = 0; i < faces.triangles.size(); ++i) {
    CHECK(fields[0].values[i] == static_cast<double>(cdem::BondMode::broken_tension));
    CHECK(fields[1].values[i] == 1);
    CHECK(fields[2].values[i] > 1e-5); // led apart by 0.6 m x 0.02 / s x 0.01 s = 1.2e-4 m
    CHECK(fields[2].values[i] < 1.5e-4);
    CHECK(times.count(fields[4].values[i]) == 1);
    CHECK(fields[5].values[i] == 0);
  }
}

TEST_CASE("cracks: faces that are damaged and not broken are on the surface when asked for",
          "[cracks][snapshot]") {
  cdem::Simulation s = two_slabs(softening_joint(cdem::Softening::linear));
  lead(s, {0, 0, 4e-5}, 8);
  CHECK(cdem::crack_surface(s.model(), s.state(), s.log().breaks, false, "").bonds.triangles.empty());
  const cdem::Snapshot damaged = cdem::crack_surface(s.model(), s.state(), s.log().breaks, true, "");
  REQUIRE(!damaged.bonds.triangles.empty());
  CHECK(std::isnan(damaged.bonds.triangle_fields[4].values[0]));
  CHECK(damaged.bonds.triangle_fields[5].values[0] == -1);
  double area = 0;
  for (std::size_t i = 0; i < damaged.bonds.triangles.size(); ++i) {
    const geom::Triangle& t = damaged.bonds.triangles[i];
    const auto& x = damaged.bonds.points;
    area += 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm() *
            damaged.bonds.triangle_fields[1].values[i];
  }
  CHECK(area == Approx(s.cracks().all().damaged).epsilon(0.01));
}
