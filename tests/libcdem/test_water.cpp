// Water in joints: effective stress, load on open faces, and the planar slide of Hoek and Bray (Rock Slope Engineering,
// 3rd ed. 1981, chapter 7) with a water-filled tension crack.
#include "tests/libcdem/system.hpp"

#include "libcdem/load/water.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

const cdem::Selection top = cdem::Selection::side("z+"), bottom = cdem::Selection::side("z-");

geom::Assembly cut(const geom::Assembly& a, const Vec3& point, const Vec3& normal, const std::string& name) {
  geom::PlaneCutOptions options;
  options.name = name;
  return geom::cut_by_plane(a, geom::Plane::through(point, normal), options);
}

cdem::Joint coulomb(double angle) {
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = angle;
  return joint;
}

// Two blocks of 1 x 1 x 1 m under a pressure of 1 MPa, a level joint "seam" at z = 1.
cdem::Simulation column(const cdem::Joint& joint, cdem::Element element) {
  cdem::BodySpec body;
  body.name = "rock";
  body.shape = cut(geom::grid({1, 1, 2}, {1, 1, 1}), {0, 0, 1}, {0, 0, 1}, "seam");
  body.material = rock();
  body.material.poissons_ratio = 0;
  body.joint = rock_joint();
  body.set_joints["seam"] = joint;
  body.element = element;
  cdem::ModelSpec spec;
  spec.bodies = {body};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(bottom));
  s.traction(traction(top, {0, 0, -1e6}));
  return s;
}

cdem::Water at_pressure(double pressure) {
  cdem::Water water;
  water.pressure = [pressure](const Vec3&) { return pressure; };
  return water;
}

const auto elements = {cdem::Element::small_strain, cdem::Element::finite_volume};

// A cliff of 8 m: a plane that dips out of it at its foot, a vertical crack 6 m behind it. 1 m wide.
struct Slide {
  double dip = 35 * degree, width = 6, height = 8, filled = 1; // filled: part of the crack's depth
  double weight = 9810;                                        // N/m3, of water

  double crack_bottom() const { return width * std::tan(dip); }
  double head() const { return filled * (height - crack_bottom()); } // m
  double foot() const { return 10; }                                 // x
  double crack() const { return foot() - width; }

  // In the crack hydrostatic, along the plane falling evenly to 0 at the foot.
  double pressure(const Vec3& x) const {
    if (x.x() < crack() + 1e-6)
      return std::max(0.0, weight * (crack_bottom() + head() - x.z()));
    return weight * head() * (foot() - x.x()) / width;
  }
  // Where the driving force is that of friction.
  double critical_friction() const {
    const double area = width * (0.5 * (height - crack_bottom()) + 0.5 * height);
    const double w = rock().density * 9.81 * area, v = 0.5 * weight * head() * head(),
                 u = 0.5 * weight * head() * width / std::cos(dip);
    return (w * std::sin(dip) + v * std::cos(dip)) / (w * std::cos(dip) - u - v * std::sin(dip));
  }

  cdem::Simulation operator()(double tan_friction, cdem::Element element) const {
    const geom::Assembly cliff = cut(geom::grid({foot(), 1, height}, {1, 1, 1}), {foot(), 0, 0},
                                     {std::sin(dip), 0, std::cos(dip)}, "plane");
    cdem::ModelSpec spec;
    for (const char* name : {"base", "slider", "back"}) {
      cdem::BodySpec part = body(name, {});
      part.element = element;
      spec.bodies.push_back(part);
    }
    for (const geom::Polyhedron& block : cut(cliff, {crack(), 0, height}, {1, 0, 0}, "crack").blocks) {
      const Vec3 c = geom::mass_properties(block).centroid;
      const bool below = c.z() < (foot() - c.x()) * std::tan(dip);
      spec.bodies[below ? 0 : c.x() > crack() ? 1 : 2].shape.blocks.push_back(block);
    }
    const cdem::Joint plane = coulomb(std::atan(tan_friction));
    spec.pairs = {{"base", "slider", plane}, {"base", "back", plane}, {"slider", "back", coulomb(0)}};
    cdem::Simulation s(spec, 1, nullptr);
    s.fix(fixed(cdem::Selection::of_body("base")));
    s.fix(fixed(cdem::Selection::of_body("back")));
    s.gravity(gravity());
    return s;
  }
  void fill(cdem::Simulation& s) const {
    cdem::Water water;
    water.pressure = [slide = *this](const Vec3& x) { return slide.pressure(x); };
    s.water(water);
  }
  static bool stands(cdem::Simulation& s) {
    cdem::RelaxOptions options;
    options.max_steps = 4000;
    return s.relax(options).converged;
  }
};

} // namespace

TEST_CASE("a joint bears the effective stress: what water takes, the spring does not", "[water]") {
  const auto element = GENERATE(from_range(elements));
  cdem::Simulation s = column(coulomb(30 * degree), element);
  CHECK(s.water(at_pressure(0.4e6)).force == Approx(0.4e6));
  REQUIRE(s.relax({}).converged);
  const cdem::JointSum seam = s.joints({{"seam"}, {}}).at(0);
  CHECK(seam.normal == Approx(-0.6e6).epsilon(1e-5));
  CHECK(seam.water == Approx(0.4e6));
  CHECK(s.mean("stress.zz") == Approx(-1e6).epsilon(1e-5)); // the rock bears the total stress
  s.water(at_pressure(0));
  REQUIRE(s.relax({}).converged);
  CHECK(s.joints({{"seam"}, {}}).at(0).normal == Approx(-1e6).epsilon(1e-5));
}

TEST_CASE("friction is that of the effective stress", "[water]") {
  const auto element = GENERATE(from_range(elements));
  const double tan_phi = std::tan(30 * degree), p = 0.4e6;
  const double part = GENERATE(0.97, 1.03); // of what friction holds
  cdem::Simulation s = column(coulomb(30 * degree), element);
  s.water(at_pressure(p));
  cdem::Fix lower =
      fixed(cdem::Selection::where([](const Vec3& x) { return x.z() < 0.99; }, "the lower block"));
  s.fix(lower);
  cdem::Traction push = traction(cdem::Selection::side("x-"), {0, 0, 0});
  push.stress = {part * tan_phi * (1e6 - p), 0, 0};
  s.traction(push);
  cdem::RelaxOptions options;
  options.max_steps = 4000;
  CHECK(s.relax(options).converged == (part < 1));
}

TEST_CASE("water tears a bonded joint at its effective strength, and loads the open crack", "[water]") {
  const auto element = GENERATE(from_range(elements));
  cdem::Joint bond = coulomb(30 * degree);
  bond.bonded = true;
  bond.cohesion = 10e6;
  bond.tensile_strength = 0.5e6;
  cdem::Simulation s = column(bond, element);
  s.clear_loads();
  s.fix(fixed(top));           // what opens presses on the rock above and below
  s.water(at_pressure(0.1e6)); // what comes at once overshoots
  REQUIRE(s.relax({}).converged);
  CHECK(s.counts().broken_tension == 0);
  s.water(at_pressure(100e6)); // moving blocks are left to contact, and the water stays
  REQUIRE(s.relax({}).converged);
  CHECK(s.counts().broken_tension == s.counts().bonds);
  const cdem::JointSum seam = s.joints({{"seam"}, {}}).at(0);
  CHECK((element == cdem::Element::small_strain ? seam.open_area == Approx(1) : seam.parted == 1));
  CHECK(s.reaction(top).z() == Approx(-100e6).epsilon(1e-4));
}

TEST_CASE("the energy balance counts the work of water that opens a joint", "[water]") {
  const auto element = GENERATE(from_range(elements));
  cdem::Joint soft = coulomb(30 * degree); // opens and closes in many steps
  soft.normal_stiffness = soft.shear_stiffness = 5e9;
  cdem::Simulation s = column(soft, element);
  REQUIRE(s.relax({}).converged);
  s.water(at_pressure(0.7e6));
  cdem::RunOptions options;
  options.duration = 5e-3;
  s.run(options);
  s.water(at_pressure(0.2e6)); // what was done stays done
  s.run(options);
  CHECK(s.energy().kinetic > 0.01 * s.energy().external_peak);
  CHECK(s.energy().balance_error() < 2e-3);
}

TEST_CASE("a planar slide begins at the friction of Hoek and Bray's formula", "[water][hoek_bray]") {
  const auto element = GENERATE(from_range(elements));
  Slide slide;
  slide.filled = GENERATE(0.0, 0.5, 1.0);
  const double exact = slide.critical_friction();
  double slides = 0.9 * exact, stands = 1.1 * exact;
  for (int i = 0; i < 4; ++i) {
    const double middle = 0.5 * (slides + stands);
    cdem::Simulation s = slide(middle, element);
    if (slide.filled > 0)
      slide.fill(s);
    (Slide::stands(s) ? stands : slides) = middle;
  }
  CAPTURE(slide.filled, slides / exact, stands / exact);
  CHECK(slides > 0.98 * exact);
  CHECK(stands < 1.02 * exact);
}

TEST_CASE("a slope that a reservoir holds slides when it is drawn down and the joints still hold water",
          "[water][drawdown]") {
  const auto element = GENERATE(from_range(elements));
  Slide slide;
  const double dry = Slide{slide.dip, slide.width, slide.height, 0}.critical_friction(),
               wet = slide.critical_friction();
  REQUIRE(wet > 1.3 * dry);
  cdem::Simulation s = slide(0.5 * (dry + wet), element);
  const cdem::Selection face = cdem::Selection::side("x+");
  slide.fill(s);
  s.traction(traction(face, {-0.5 * slide.weight * slide.height, 0, 0})); // full reservoir, in the mean
  CHECK(Slide::stands(s));
  s.clear_loads();
  s.gravity(gravity());
  CHECK_FALSE(Slide::stands(s)); // rapid drawdown
  s.water(at_pressure(0));       // drained
  CHECK(Slide::stands(s));
}

TEST_CASE("water stays in the joints that are left when blocks are taken out, and what is cut is dry",
          "[water]") {
  cdem::BodySpec rocks =
      body("rock", cut(cut(geom::grid({1, 1, 3}, {1, 1, 1}), {0, 0, 1}, {0, 0, 1}, "lower"), {0, 0, 2},
                       {0, 0, 1}, "upper"));
  cdem::ModelSpec spec;
  spec.bodies = {rocks};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(bottom));
  s.gravity(gravity());
  cdem::Water water;
  water.level = 3;
  s.water(water);
  REQUIRE(s.relax({}).converged);
  const auto pressures = [&] {
    std::map<std::string, double> of_set;
    for (const cdem::JointSum& sum : s.joints({}))
      of_set[sum.set] = sum.water;
    return of_set;
  };
  CHECK(pressures()["lower"] == Approx(2 * 9810.0));
  CHECK(pressures()["upper"] == Approx(9810.0));
  CHECK(s.remove(cdem::Selection::where([](const Vec3& x) { return x.z() > 2; }, "the top block")) == 1);
  CHECK(pressures().size() == 1);
  CHECK(pressures()["lower"] == Approx(2 * 9810.0));
  cdem::RefineOptions options;
  options.region = cdem::Selection::where([](const Vec3& x) { return x.z() > 1; }, "the upper block");
  options.tension_threshold = 1e12;
  options.shear_threshold = 1e12; // cut whatever bears anything
  REQUIRE_FALSE(s.refine(options).empty());
  CHECK(pressures()["lower"] == Approx(2 * 9810.0));
  CHECK(pressures()[""] == 0);
  CHECK(s.relax({}).converged);
}

TEST_CASE("a table of pressures over height is straight between rows", "[water]") {
  const auto p = cdem::pressure_over_height({{0, 2e5}, {10, 1e5}, {20, 0}});
  CHECK(p({0, 0, -5}) == 2e5);
  CHECK(p({0, 0, 5}) == Approx(1.5e5));
  CHECK(p({3, 1, 15}) == Approx(0.5e5));
  CHECK(p({0, 0, 25}) == 0);
}

TEST_CASE("water where there can be none is refused", "[water]") {
  cdem::Simulation s = column(coulomb(30 * degree), cdem::Element::small_strain);
  cdem::Water water;
  water.level = 2.5;
  CHECK_THROWS_WITH(s.water(water),
                    Contains("level = 2.5: must be a height z of at most the top of the model, "
                             "2 m") &&
                        Contains("press on its surface too"));
  water.level = -1;
  CHECK_THROWS_WITH(s.water(water), Contains("at least the bottom of the model, 0 m"));
  water.level = 1.5;
  CHECK(s.water(water).largest == Approx(0.5 * 9810));
  water.sets = {"seem"};
  CHECK_THROWS_WITH(s.water(water), Contains("joints = \"seem\"") && Contains("\"seam\""));
  water.sets.clear();
  water.weight = 0;
  CHECK_THROWS_WITH(s.water(water), Contains("weight = 0"));
  CHECK_THROWS_WITH(s.water(at_pressure(-1)),
                    Contains("(0") && Contains("= -1: must be a finite number >= 0 Pa"));
  CHECK_THROWS_WITH(cdem::pressure_over_height({{0, 1}, {0, 2}}), Contains("pressure[2] = 0: must be above"));
  CHECK_THROWS_WITH(cdem::pressure_over_height({{0, 1}}), Contains("at least two rows"));
}
