// Bonds on the faces of a mesh, their strengths and the contact they leave: two halves of a box led apart.
#include "tests/libcdem/two_halves.hpp"

#include "libcdem/results/energy.hpp"
#include "libcdem/results/fragments.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

geom::Mat3 some_turn() {
  return rotation({1, -2, 0.5}, 70 * degree);
}

cdem::Simulation simulation_of(const cdem::Joint& j, int cells) {
  cdem::ModelSpec spec;
  cdem::Bonding bonding = between_halves();
  bonding.shear_ratio = 1;
  spec.bodies = {meshed("unit", two_halves(cells), bonding, rock(), j)};
  return cdem::Simulation(spec, 1, nullptr);
}

} // namespace

TEST_CASE("face bonds: tension up to T A, nothing above", "[bonds][mesh]") {
  const geom::Mat3 turn = GENERATE(geom::Mat3(geom::Mat3::Identity()), some_turn());
  const double strength = halves_joint().tensile_strength;
  Halves halves(halves_joint(), turn);
  CHECK((halves.go({0, 0, 0.999 * strength}) + Vec3(0, 0, 0.999 * strength)).norm() < 1e-7 * strength);
  CHECK(halves.with_mode(cdem::BondMode::intact) == springs);
  CHECK(halves.go({0, 0, 1.001 * strength}).norm() == 0);
  CHECK(halves.with_mode(cdem::BondMode::broken_tension) == springs);
  for (const cdem::FaceBreak& row : halves.breaks())
    CHECK(row.normal_traction == Approx(strength).epsilon(2e-3));
}

TEST_CASE("face bonds: shear up to (c - t_n tan phi) A, then friction alone", "[bonds][mesh]") {
  const geom::Mat3 turn = GENERATE(geom::Mat3(geom::Mat3::Identity()), some_turn());
  const double tn = GENERATE(-8e6, -2e6, -1e5, 0.0, 1e6);
  const double tangent = std::tan(halves_joint().friction_angle);
  const double strength = halves_joint().cohesion - tn * tangent;
  const Vec3 along(0.6, -0.8, 0);
  Halves halves(halves_joint(), turn);
  const Vec3 before = halves.go(0.999 * strength * along + Vec3(0, 0, tn));
  CHECK((before + 0.999 * strength * along + Vec3(0, 0, tn)).norm() < 1e-7 * strength);
  CHECK(halves.with_mode(cdem::BondMode::intact) == springs);

  const Vec3 after = halves.go(1.001 * strength * along + Vec3(0, 0, tn));
  CHECK(halves.with_mode(cdem::BondMode::broken_shear) == springs);
  const Vec3 friction = std::max(0.0, -tn) * tangent * along;
  CHECK((after + friction + Vec3(0, 0, std::min(tn, 0.0))).norm() < 1e-7 * strength);
}

TEST_CASE(
    "face bonds: whichever way they are loaded they break at the nearer of their strengths and not before",
    "[bonds][mesh]") {
  const double ratio = GENERATE(0.4, 1.0, 2.5);
  const double tensile = GENERATE(0.2e6, 1.5e6, 9e6);
  cdem::Joint joint = halves_joint();
  joint.tensile_strength = tensile;
  const double tangent = std::tan(joint.friction_angle);
  for (double angle = 0; angle <= 180; angle += 7.5) { // from the normal
    const double c = std::cos(angle * degree), s = std::sin(angle * degree);
    const Vec3 direction(0.8 * s, 0.6 * s, c);
    const double slope = s + c * tangent; // the shear strength is reached at C / slope
    const double strength = std::min(c > 1e-12 ? joint.tensile_strength / c : 1e12,
                                     slope > 1e-12 ? joint.cohesion / slope : 1e12);
    if (strength > 1e9)
      continue; // pressed, it never breaks
    INFO("at " << angle << " degrees, shear ratio " << ratio << ", T " << tensile);
    Halves halves(joint, some_turn(), ratio);
    halves.go(0.999 * strength * direction);
    CHECK(halves.with_mode(cdem::BondMode::intact) == springs);
    halves.go(1.001 * strength * direction);
    CHECK(halves.with_mode(cdem::BondMode::intact) == 0);
  }
}

TEST_CASE("face bonds: a broken one and a contact that never was bonded give the same forces",
          "[bonds][mesh]") {
  Halves broken(halves_joint(), some_turn()), never(halves_joint(false), some_turn());
  CHECK(never.with_mode(cdem::BondMode::contact) == springs);
  const Vec3 path[] = {{0, 0, 2e6},        {0, 0, 1e5},        {1e6, 0, -1e6},       {3e6, 1e6, -2e6},
                       {-2e6, 4e6, -1e6},  {-2e6, 4e6, -5e6},  {0, 0, -5e6},         {1e6, 1e6, 1e6},
                       {2e6, 1e6, -3e6},   {2.5e6, 1e6, -3e6}, {-9e6, -9e6, -0.1e6}, {-8e6, -9e6, -10e6},
                       {-8e6, -9e6, -1e-3}};
  double largest = 0;
  for (const Vec3& traction : path) {
    const Vec3 a = broken.go(traction), b = never.go(traction);
    INFO("at " << traction.transpose() << ": " << a.transpose() << " against " << b.transpose());
    CHECK((a - b).norm() <= 1e-12 * 1e6);
    largest = std::max(largest, b.norm());
  }
  CHECK(largest > 1e7);
  CHECK(broken.with_mode(cdem::BondMode::broken_tension) == springs);
}

TEST_CASE("face bonds: nodes are shared wherever no joint is asked for", "[bonds][mesh]") {
  // Two cells along each axis in each half: (3 x 3 x 5) nodes, 8 cells of 6 tets in each half.
  const auto built = [](const cdem::Bonding& bonding) {
    return build({meshed("unit", two_halves(2), bonding, rock(), halves_joint())});
  };
  const auto faces = [](const cdem::Model& model) {
    int count = 0;
    each_face_spring(model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace&) { ++count; });
    return count / 3;
  };
  const int tets = 2 * 8 * 6, outer = 4 * 2 * 8 + 2 * 8, inner = (4 * tets - outer) / 2;
  SECTION("none") {
    const cdem::Model model = built({});
    CHECK(model.node_position.size() == 45);
    CHECK(faces(model) == 0);
  }
  SECTION("between regions: the nine nodes of the plane are there twice") {
    const cdem::Model model = built(between_halves());
    CHECK(model.node_position.size() == 45 + 9);
    CHECK(faces(model) == 8);
  }
  SECTION("one region: its tets have their own nodes, the others keep theirs") {
    cdem::Bonding bonding;
    bonding.regions = {1};
    const cdem::Model model = built(bonding);
    CHECK(model.node_position.size() == 27 + 4 * tets / 2);
    CHECK(faces(model) == (4 * tets / 2 - (outer - 8 - 4 * 8) - 8) / 2 + 8);
  }
  SECTION("everywhere") {
    cdem::Bonding bonding;
    bonding.everywhere = true;
    const cdem::Model model = built(bonding);
    CHECK(model.node_position.size() == 4 * static_cast<std::size_t>(tets));
    CHECK(faces(model) == inner);
  }
}

TEST_CASE("face bonds: a body pulled apart breaks between its regions and falls into them", "[bonds][mesh]") {
  cdem::Simulation s = simulation_of(halves_joint(), 2);
  s.fix(fixed(cdem::Selection::side("z-")));
  REQUIRE(s.fragments().size() == 1);
  CHECK(s.fragments()[0].volume == Approx(area * 2 * half).epsilon(1e-12));
  cdem::Traction pull;
  pull.on = cdem::Selection::side("z+");
  pull.stress = {0.5e6, 0, 2e6}; // in the middle of a bar the step passes once without overshoot
  s.traction(pull);
  cdem::RunOptions options;
  options.steps = 400;
  s.run(options);
  CHECK(s.counts().intact == 0);
  CHECK(s.log().breaks.size() == static_cast<std::size_t>(s.counts().bonds));
  for (const cdem::BreakRow& row : s.log().breaks)
    CHECK(row.place.z() == Approx(half).epsilon(1e-12));
  const auto pieces = s.fragments();
  REQUIRE(pieces.size() == 2);
  for (const cdem::Fragment& piece : pieces) {
    CHECK(piece.volume == Approx(area * half).epsilon(1e-12));
    CHECK(piece.tets == 48);
    CHECK(piece.held == (piece.centroid.z() < half));
    CHECK(std::abs(piece.centroid.z() - half) == Approx(half / 2).epsilon(1e-12));
  }
}

TEST_CASE("face bonds: break_bonds makes them contacts, which still carry pressure", "[bonds][mesh]") {
  const bool whole_faces = GENERATE(false, true);
  cdem::Simulation s = simulation_of(halves_joint(), 2);
  s.fix(fixed(cdem::Selection::side("z-")));
  const auto left =
      cdem::Selection::where([](const Vec3& x) { return x.x() < 0.49 * side; }, "the left half");
  const auto plane = cdem::Selection::on_plane(geom::Plane::through({0, 0, half}, {0, 0, 1}));
  CHECK(s.break_bonds(left, whole_faces) == 12);
  CHECK(s.fragments().size() == 1);
  CHECK(s.break_bonds(plane, whole_faces) == 24);
  CHECK(s.counts().contacts == 24);
  CHECK(s.counts().intact == 0);
  CHECK(s.fragments().size() == 2);
  s.traction(traction(cdem::Selection::side("z+"), {0, 0, -1e6}));
  REQUIRE(s.relax({}).converged);
  CHECK(s.reaction(cdem::Selection::side("z-")).z() == Approx(1e6 * area).epsilon(1e-5));
}

TEST_CASE("face bonds: the energy balance closes where one half slides over the other", "[energy][mesh]") {
  cdem::Joint rough = halves_joint(false);
  System s(build({meshed("unit", two_halves(2), between_halves(), rock(), rough)}));
  s.hold(cdem::Selection::side("z-"), "xyz");
  cdem::Traction push;
  push.on = cdem::Selection::side("z+");
  push.stress = {1e6, 0.3e6, -1e6}; // tan(phi) = 0.70
  s.conditions.tractions = {push};
  cdem::RunOptions options;
  options.steps = 2000;
  options.safety = 0.5;
  s.run(options);
  const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
  INFO("friction " << ledger.friction << " of " << ledger.external << " J, error " << ledger.balance_error());
  CHECK(ledger.friction > 0.1 * ledger.external);
  CHECK(ledger.balance_error() < 1e-3);
}
