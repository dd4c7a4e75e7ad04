// A crack that grows in stages: what breaks, where it goes, when it stops, and what grow refuses.
#include "libcdem/procedure/grow.hpp"
#include "libcdem/simulation.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libcdem/system.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace cdem;
using geom::Vec3;
using testing::degree;

namespace {

constexpr double length = 0.9, height = 0.3, depth = 0.06, notch = 0.06; // m
constexpr double tolerance = 1e-6;                                       // m, of places

Joint brittle() {
  Joint j;
  j.cohesion = 10e6;
  j.friction_angle = 30 * degree;
  j.tensile_strength = 2e6;
  return j;
}

// Three-point bending about mid-span, in plane strain; the notch runs up the middle of the middle column.
Simulation notched_beam(double load, const Joint& joint = brittle()) {
  const geom::Assembly grid = geom::grid({length, height, depth}, {15, 5, 1});
  const geom::Box at_notch{{length / 2 - 0.01, 0, 0}, {length / 2 + 0.01, 0.9 * notch, depth}};
  Simulation s = testing::simulation(
      geom::cut_by_plane(grid, geom::Plane::through({length / 2, 0, 0}, {1, 0, 0}), {{}, 0, at_notch}),
      testing::rock(), joint);
  const auto hold = [&](const Selection& on, std::array<bool, 3> axes) {
    Fix fix;
    fix.on = on;
    fix.axes = axes;
    s.fix(fix);
  };
  hold(Selection::side("z-"), {false, false, true});
  hold(Selection::side("z+"), {false, false, true});
  const auto edge = [](double x, double y) {
    return Selection::where(
        [x, y](const Vec3& p) { return std::abs(p.x() - x) < tolerance && std::abs(p.y() - y) < tolerance; },
        "an edge");
  };
  hold(edge(0, 0), {true, true, false});
  hold(edge(length, 0), {true, true, false});
  s.force({edge(length / 2, height), {0, -load, 0}, {}});
  s.break_bonds(Selection::in_box({{length / 2 - tolerance, 0, 0}, {length / 2 + tolerance, notch, depth}}),
                true);
  return s;
}

std::string refused(const GrowOptions& options, const Joint& joint = brittle()) {
  return testing::refusal([&] { notched_beam(1e3, joint).grow(options); });
}

std::string refused(const std::function<void(GrowOptions&)>& change) {
  GrowOptions options;
  change(options);
  return refused(options);
}

FaceLoad carrying(double ratio) {
  FaceLoad load;
  load.ratio.value = ratio;
  return load;
}

} // namespace

TEST_CASE("the load ratio is one over the factor that brings a traction to its strength") {
  const SpringStrength strength{8e6, std::tan(30 * degree), 5e6};
  CHECK(load_ratio(strength, 2.5e6, 0).value == Approx(0.5));
  CHECK(load_ratio(strength, 2.5e6, 0).mode == BondMode::broken_tension);
  // Pressed by 3 MPa: the limit c0 - t_n tan(phi) grows with the pressure, and so does the load.
  const double t = 3e6, factor = 8e6 / (4e6 - t * std::tan(30 * degree));
  CHECK(load_ratio(strength, -t, 4e6).value == Approx(1 / factor));
  CHECK(load_ratio(strength, -t, 4e6).mode == BondMode::broken_shear);
  CHECK(load_ratio(strength, -t, 0).value == 0);
  CHECK(load_ratio({0, 0, 0}, 1, 0).value == std::numeric_limits<double>::infinity());
}

TEST_CASE("only faces at their strength that carry break_ratio of the worst one's ratio break") {
  const std::vector<FaceLoad> loads{carrying(0.95), carrying(2.0), carrying(1.81), carrying(1.79),
                                    carrying(1.0)};
  const auto count = [&](double break_ratio) { return worst_faces(loads, break_ratio).size(); };
  CHECK(count(1.0) == 1);
  CHECK(count(0.9) == 2);
  CHECK(count(0.5) == 4); // 1.0 is at its strength, 0.95 is not, whatever the ratio
  CHECK(count(0.1) == 4);
  CHECK(worst_faces({carrying(0.99)}, 0.1).empty());
}

TEST_CASE("the load of a face is its mean traction") {
  const double stress = 3e6;
  testing::System bar(testing::build(
      {testing::body("bar", geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}), testing::rock(), brittle())}));
  bar.hold(Selection::side("x-"), "x");
  bar.hold(testing::at_place({0, 0, 0}), "yz");
  bar.hold(testing::at_place({0, 0.1, 0}), "z");
  bar.conditions.tractions.push_back({Selection::side("x+"), {stress, 0, 0}, {}});
  bar.relax(1e-10);
  const std::vector<FaceLoad> loads = face_loads(bar.model, bar.state);
  REQUIRE(loads.size() == 1);
  CHECK(loads[0].normal_traction == Approx(stress).epsilon(1e-8));
  CHECK(loads[0].shear_traction < 1e-8 * stress);
  CHECK(loads[0].ratio.value == Approx(stress / 2e6).epsilon(1e-8));
}

TEST_CASE("a symmetric notch grows straight up towards the load above it") {
  Simulation beam = notched_beam(200e3);
  GrowOptions options;
  options.passes = 20;
  options.residual = 1e-7;
  const GrowResult grown = beam.grow(options);
  const std::vector<Vec3> path = grown.passes.back().path;
  REQUIRE(path.size() > 3);
  CHECK(path.front().y() < tolerance);
  CHECK(path.back().y() > 0.5 * height);
  for (const Vec3& x : path)
    CHECK(std::abs(x.x() - length / 2) < 1e-4 * height);
  for (const GrowPass& pass : grown.passes)
    for (const CrackFace& face : pass.faces)
      CHECK(face.mode == BondMode::broken_tension);
}

TEST_CASE("an anchored plane passes through the crack's tip") {
  Simulation beam = notched_beam(200e3);
  // Off the middle the plane has to turn, and still meets the tip.
  beam.force(
      {Selection::where(
           [](const Vec3& x) { return x.y() > height - tolerance && std::abs(x.x() - 0.57) < tolerance; },
           "the top"),
       {0, -200e3, 0},
       {}});
  Vec3 tip(length / 2, notch, depth / 2);
  GrowOptions options;
  options.callback = [&](const GrowPass& pass) {
    CAPTURE(pass.pass);
    REQUIRE(pass.cuts.size() == 1);
    REQUIRE(pass.faces.size() == 1);
    const CrackFace& face = pass.faces[0];
    CHECK(std::abs(face.normal.x()) < 1 - 1e-6);
    CHECK(std::abs(face.normal.dot(face.centroid - tip)) < tolerance);
    tip = pass.tip;
  };
  options.passes = 2;
  CHECK(beam.grow(options).passes.size() == 2);
}

TEST_CASE("below the load that starts it a crack stays where it is, and the result says so") {
  // Ratios grow in proportion to the load as long as nothing breaks: one over them tells where it starts.
  Simulation probe = notched_beam(1e3);
  GrowOptions options;
  options.residual = 1e-7;
  options.passes = 5;
  const GrowResult held = probe.grow(options);
  CHECK(held.state == GrowState::arrested);
  CHECK(probe.log().breaks.empty());
  for (const GrowPass& pass : held.passes) {
    CHECK(pass.faces.empty());
    CHECK(pass.first_ratio < 1);
    CHECK((pass.tip - Vec3(length / 2, notch, depth / 2)).norm() < tolerance);
  }
  const double start = 1e3 / held.passes.front().first_ratio;

  Simulation below = notched_beam(0.999 * start), above = notched_beam(1.001 * start);
  CHECK(below.grow(options).state == GrowState::arrested);
  CHECK(below.log().breaks.empty());
  options.passes = 1;
  CHECK(above.grow(options).passes.front().faces.size() == 1);
}

TEST_CASE("the energy of the springs that grow breaks is in the ledger") {
  Simulation beam = notched_beam(200e3);
  GrowOptions options;
  options.residual = 1e-7;
  beam.grow(options);
  CHECK(beam.energy().breaking > 0);
  CHECK(beam.energy().balance_error() < 1e-3);
  CHECK(beam.counts().broken_tension == static_cast<std::int64_t>(beam.log().breaks.size()));
}

TEST_CASE("grow refuses values that cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refused([](GrowOptions& o) { o.passes = 0; }) == "passes = 0: must be an integer >= 1");
  CHECK(refused([](GrowOptions& o) { o.break_ratio = 0; }) ==
        "break_ratio = 0: must be in (0, 1]; 0.9 breaks the worst face and those within a tenth of it");
  CHECK(refused([](GrowOptions& o) { o.break_ratio = 1.1; }).find("break_ratio = 1.1: must be in (0, 1]") ==
        0);
  CHECK(refused([&](GrowOptions& o) { o.break_ratio = nan; }).find("break_ratio = nan: must be in (0, 1]") ==
        0);
  CHECK(refused([](GrowOptions& o) { o.tip_radius = 0; }) ==
        "tip_radius = 0: must be a finite number > 0 m; one block size is usual");
  CHECK(refused([](GrowOptions& o) {
          o.tip_radius = std::numeric_limits<double>::infinity();
        }).find("tip_radius = inf") == 0);
  CHECK(refused([](GrowOptions& o) { o.residual = 0; }) == "residual = 0: must be in (0, 1); 1e-5 is usual");
  CHECK(refused([](GrowOptions& o) { o.residual = 1; }).find("residual = 1") == 0);
  CHECK(refused([](GrowOptions& o) { o.max_steps = 0; }) == "max_steps = 0: must be an integer >= 1");
  CHECK(refused([](GrowOptions& o) { o.max_rounds = -1; }) == "max_rounds = -1: must be an integer >= 1");
  CHECK(refused([](GrowOptions& o) { o.refine.planes = 0; }) == "planes = 0: must be an integer in 1..15");
  CHECK(refused([](GrowOptions& o) { o.refine.max_depth = 7; }) ==
        "max_depth = 7: must be an integer in 1..6");
  CHECK(refused([](GrowOptions&) {}).empty());
}

TEST_CASE("grow refuses joints that soften") {
  Joint joint = brittle();
  joint.softening = Softening::linear;
  joint.fracture_energy_1 = 100;
  joint.fracture_energy_2 = 400;
  CHECK(refused({}, joint) ==
        "the joint inside \"body\" softens (softening = \"linear\"), and grow breaks whole faces at "
        "their "
        "strength; leave softening out, or load in small increments with relax, which follows the curve");
}
