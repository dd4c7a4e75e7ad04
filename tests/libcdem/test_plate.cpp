// Han 2010 example 4.1: plate 0.3 x 0.3 x 0.03 m in plane strain under 30 MPa, foot clamped, head held
// sideways. Fine finite elements: mean head displacement -2.7375e-4 m, side displacement at
// mid-height 4.665e-5 m.
#include "tests/libcdem/system.hpp"
#include "tests/libcdem/tied_solution.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double plate_side = 0.3;
constexpr double fine_fe_head = -2.7375e-4, fine_fe_side = 4.665e-5; // m

geom::Assembly blocks(int divisions) {
  return geom::grid({plate_side, plate_side, plate_side / divisions}, {divisions, divisions, 1});
}

cdem::Simulation plate(int divisions, double thickness_ratio, double pressure) {
  cdem::Joint joint = rock_joint();
  joint.thickness_ratio = thickness_ratio;
  cdem::Simulation s = simulation(blocks(divisions), rock(), joint);
  s.fix(fixed(cdem::Selection::side("z-"), "z"));
  s.fix(fixed(cdem::Selection::side("z+"), "z"));
  s.fix(fixed(cdem::Selection::side("y-"), "xyz"));
  s.fix(fixed(cdem::Selection::side("y+"), "xz"));
  s.traction(traction(cdem::Selection::side("y+"), {0, -pressure, 0}));
  return s;
}

double head(int divisions, double thickness_ratio) {
  cdem::Simulation s = plate(divisions, thickness_ratio, 30e6);
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  return s.mean("displacement.y", cdem::Selection::side("y+"));
}

// The same without springs: nodes of neighbours are one.
double tied_head(int divisions) {
  const cdem::Model model = build({body("rock", blocks(divisions))});
  TiedProblem problem;
  const double depth = plate_side / divisions;
  problem.held = [=](const Vec3& x) -> std::array<bool, 3> {
    const bool foot = x.y()<1e-9, top = x.y()> plate_side - 1e-9,
               flank = x.z() < 1e-9 || x.z() > depth - 1e-9;
    return {foot || top, foot, foot || top || flank};
  };
  problem.traction = [](const Vec3& centre, const Vec3&) {
    return centre.y() > plate_side - 1e-9 ? Vec3(0, -30e6, 0) : Vec3(0, 0, 0);
  };
  const std::vector<Vec3> u = tied_solution(model, problem);
  double sum = 0, area = 0;
  for (const cdem::OuterFace& face : model.outer_faces)
    if (face.normal.y() > 0.5)
      for (const auto& [node, a] : face.node_area) {
        sum += a * u[node].y();
        area += a;
      }
  return sum / area;
}

} // namespace

TEST_CASE("the plate's head settles within 2 % of fine finite elements at L = 0.02 h", "[plate]") {
  cdem::Simulation s = plate(10, 0.02, 30e6);
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  CHECK(s.mean("displacement.y", cdem::Selection::side("y+")) == Approx(fine_fe_head).epsilon(0.02));
  CHECK(s.at("displacement.x", {plate_side, plate_side / 2, plate_side / 20}) ==
        Approx(fine_fe_side).epsilon(0.02));
  // Reactions carry the load: side * depth * 30 MPa.
  CHECK(s.reaction(cdem::Selection::side("y-")).y() ==
        Approx(30e6 * plate_side * plate_side / 10).epsilon(1e-5));
}

TEST_CASE("as L over h goes to 0 the plate goes to the solution without springs", "[plate]") {
  const double exact = tied_head(10);
  const double ratios[] = {0.08, 0.04, 0.02, 0.01, 0.005};
  std::vector<double> u;
  for (const double ratio : ratios)
    u.push_back(head(10, ratio));
  for (int i = 0; i + 1 < 5; ++i) {
    INFO("L/h " << ratios[i] << ": " << u[i] << " m, exact " << exact << " m");
    // Order 1 in L/h.
    CHECK((u[i] - exact) / (u[i + 1] - exact) == Approx(2).epsilon(0.05));
  }
  const double extrapolated = 2 * u[4] - u[3];
  CHECK(extrapolated == Approx(exact).epsilon(2e-4));
}

TEST_CASE("with 10 and 20 and 40 blocks a side the plate goes to fine finite elements", "[plate]") {
  const double coarse = tied_head(10), middle = tied_head(20), fine = tied_head(40);
  CAPTURE(coarse, middle, fine);
  CHECK(std::abs(middle - fine_fe_head) < 0.6 * std::abs(coarse - fine_fe_head));
  CHECK(std::abs(fine - fine_fe_head) < 0.6 * std::abs(middle - fine_fe_head));
  CHECK(fine == Approx(fine_fe_head).epsilon(1e-3));
  // The solver itself with springs of two thicknesses, extrapolated to none.
  CHECK(2 * head(20, 0.01) - head(20, 0.02) == Approx(middle).epsilon(1e-3));
}

TEST_CASE("under 24 MPa no block of the plate is cut and no bond breaks", "[plate]") {
  cdem::Simulation s = plate(10, 0.02, 24e6);
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  cdem::RefineOptions refine;
  refine.shear_threshold = 0.7e6;
  CHECK(s.refine(refine).empty());
  options.breaking = true;
  REQUIRE(s.relax(options).converged);
  CHECK(s.counts().intact == s.counts().bonds);
}

TEST_CASE("under 30 MPa 56 blocks of the plate are cut in shear along an X and the cut does not kick",
          "[plate]") {
  cdem::Simulation s = plate(10, 0.02, 30e6);
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  const double before = s.mean("displacement.y", cdem::Selection::side("y+"));
  cdem::RefineOptions refine;
  refine.shear_threshold = 0.7e6;
  const std::vector<cdem::BlockCut> cuts = s.refine(refine);
  CHECK(cuts.size() == 56);
  for (const cdem::BlockCut& cut : cuts) {
    const Vec3& n = cut.normal;
    INFO("block at (" << cut.centroid.x() << ", " << cut.centroid.y() << "), normal " << n.transpose());
    CHECK(cut.mode == cdem::CutMode::shear);
    CHECK(cut.pieces == 4);
    CHECK(std::abs(n.z()) < 1e-6);
    // The plane's trace is at right angles to the normal in x-y.
    const double from_vertical = std::atan2(std::abs(n.y()), std::abs(n.x())) / degree;
    CHECK(from_vertical > 29);
    CHECK(from_vertical < 33);
    const bool leans_back = n.x() * n.y() > 0; // like a backslash
    const bool left = cut.centroid.x()<plate_side / 2, upper = cut.centroid.y()> plate_side / 2;
    CHECK(leans_back == (left == upper));
  }
  CHECK(s.counts().blocks == 100 + 3 * 56);

  REQUIRE(s.relax(options).converged);
  // Without preload on the new springs the head would move by 4e-6 m; more springs in the blocks' way would
  // add their own compliance if they were not preloaded.
  CHECK(std::abs(s.mean("displacement.y", cdem::Selection::side("y+")) - before) < 2e-7);
}
