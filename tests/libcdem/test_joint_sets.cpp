// Laws by joint set and named cut, and glued cuts.
#include "libcdem/first_model.hpp"
#include "libcdem/fracture/rebuild.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

cdem::Joint with_strength(double tensile_strength) {
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = tensile_strength;
  joint.cohesion = 100e6;
  return joint;
}

geom::Assembly cut_at(const geom::Assembly& a, double x, const std::string& name, bool glued = false) {
  geom::PlaneCutOptions options;
  options.name = name;
  options.glued = glued;
  return geom::cut_by_plane(a, geom::Plane::through({x, 0, 0}, {1, 0, 0}), options);
}

// A bar of 3 m along x, cut at 1 m by "weak" and at 2 m by "strong" or by a glued cut; `joint` itself holds nothing.
cdem::ModelSpec bar(bool glued, cdem::Element element) {
  cdem::BodySpec body;
  body.name = "bar";
  body.shape = cut_at(cut_at(geom::grid({3, 1, 1}, {1, 1, 1}), 1, "weak"), 2, glued ? "" : "strong", glued);
  body.material = rock();
  body.joint = with_strength(0);
  body.set_joints["weak"] = with_strength(1e6);
  if (!glued)
    body.set_joints["strong"] = with_strength(30e6);
  body.element = element;
  cdem::ModelSpec spec;
  spec.bodies = {body};
  return spec;
}

} // namespace

TEST_CASE("each joint set breaks at its own strength, and a glued cut never", "[joint_sets]") {
  const bool glued = GENERATE(false, true);
  const auto element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  cdem::Simulation s(bar(glued, element), 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  const auto broken_under = [&](double stress) {
    s.clear_loads();
    s.traction(traction(cdem::Selection::side("x+"), {stress, 0, 0}));
    cdem::RelaxOptions options;
    options.max_steps = 500; // what has come loose finds no balance, and leaves its neighbour
    s.relax(options);
    return s.counts().broken_tension;
  };
  CHECK(broken_under(0.9e6) == 0);
  CHECK(s.max("stress.xx").value == Approx(0.9e6).epsilon(0.2)); // it carries the load
  const std::int64_t points = s.counts().bonds;
  CHECK(broken_under(2e6) == points / 2);
  CHECK(s.counts().intact == points / 2);
}

TEST_CASE("a glued cut is stiff: a bar gives by its own length and 0.5 % of a block", "[joint_sets]") {
  cdem::BodySpec body;
  body.name = "bar";
  body.shape = cut_at(geom::grid({2, 1, 1}, {1, 1, 1}), 1, "", true);
  body.material = rock();
  body.material.poissons_ratio = 0;
  body.joint = with_strength(0);
  body.element = cdem::Element::small_strain;
  cdem::ModelSpec spec;
  spec.bodies = {body};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  s.traction(traction(cdem::Selection::side("x+"), {1e8, 0, 0}));
  REQUIRE(s.relax({}).converged);
  CHECK(s.counts().broken_tension == 0);
  CHECK(s.mean("displacement.x", cdem::Selection::side("x+")) ==
        Approx(1e8 / rock().youngs_modulus * (2 + cdem::glued_thickness_ratio)).epsilon(1e-4));
}

// Edges of the blocks that a picture draws round the section of the bar at x.
int edges_at(const cdem::Simulation& s, double x) {
  const cdem::Snapshot shown = s.picture_snapshot({}, "");
  return static_cast<int>(
      std::count_if(shown.block_edges.begin(), shown.block_edges.end(), [&](const auto& edge) {
        return std::abs(shown.points[edge[0]].x() - x) < 1e-9 &&
               std::abs(shown.points[edge[1]].x() - x) < 1e-9;
      }));
}

TEST_CASE("a glued cut is no joint: not among the joints, and without an outline until it is open",
          "[joint_sets]") {
  const auto element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  const double zones = GENERATE(0.0, 0.6);
  if (zones > 0 && element == cdem::Element::small_strain)
    return;
  cdem::ModelSpec glued = bar(true, element), jointed = bar(false, element);
  glued.bodies[0].zone_size = jointed.bodies[0].zone_size = zones;
  cdem::Simulation s(glued, 1, nullptr), with_joint(jointed, 1, nullptr);
  CHECK(edges_at(with_joint, 1) == edges_at(with_joint, 2));
  CHECK(edges_at(s, 1) == edges_at(with_joint, 1));
  CHECK(edges_at(s, 2) == 0);
  const auto sums = s.joints({});
  REQUIRE(sums.size() == 1);
  CHECK(sums[0].set == "weak");
  const cdem::Snapshot joints = cdem::joint_surface(s.model(), s.state(), {}, "");
  for (const geom::Vec3& x : joints.bonds.points)
    CHECK(x.x() == Approx(1));
  // Dug up to it, its face is the end of the bar.
  s.remove(cdem::Selection::where([](const geom::Vec3& x) { return x.x() > 2; }, "the end"));
  CHECK(edges_at(s, 2) > 0);
}

TEST_CASE("the outline behind joints is that of the bodies, without the joints", "[joint_sets]") {
  const auto element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  const double zones = GENERATE(0.0, 0.6);
  if (zones > 0 && element == cdem::Element::small_strain)
    return;
  cdem::ModelSpec spec = bar(false, element);
  spec.bodies[0].zone_size = zones;
  cdem::Simulation s(spec, 1, nullptr);
  const auto length = [&] {
    const cdem::Snapshot joints = s.joint_picture({}, "");
    CHECK(joints.point_fields[0].values.size() == 3 * joints.points.size());
    double sum = 0;
    for (const auto& edge : joints.outline)
      sum += (joints.points[edge[1]] - joints.points[edge[0]]).norm();
    return sum;
  };
  CHECK(length() == Approx(4 * 3 + 2 * 4));
  s.remove(cdem::Selection::where([](const geom::Vec3& x) { return x.x() > 2; }, "the end"));
  CHECK(length() == Approx(4 * 2 + 2 * 4));
}

TEST_CASE("laws of joint sets stay with their faces when blocks are taken out", "[joint_sets]") {
  System s(build(bar(false, cdem::Element::small_strain).bodies));
  const auto strength_at = [](const cdem::Model& m, double x) {
    for (const cdem::Interface& i : m.interfaces)
      if (std::abs(m.point_position[i.point_begin].x() - x) < 1e-9)
        return m.joints[i.joint].tensile_strength;
    return -1.0;
  };
  CHECK(strength_at(s.model, 1) == 1e6);
  CHECK(strength_at(s.model, 2) == 30e6);
  const cdem::Rebuilt left =
      cdem::rebuild(s.model, s.state, {cdem::whole_block(s.model, 1), cdem::whole_block(s.model, 2)}, {},
                    cdem::MayBreak::all);
  CHECK(strength_at(left.model, 2) == 30e6);
}

TEST_CASE("names of joint sets that no face has are refused with those there are", "[joint_sets]") {
  cdem::ModelSpec spec = bar(false, cdem::Element::small_strain);
  spec.bodies[0].set_joints["faults"] = rock_joint();
  CHECK_THROWS_WITH(
      cdem::Simulation(spec, 1, nullptr),
      Contains("joints of body \"bar\" = \"faults\": must be the name of a joint set or cut of its shape "
               "(\"strong\", \"weak\")"));
  cdem::ModelSpec plain = bar(false, cdem::Element::small_strain);
  plain.bodies[0].shape = geom::grid({3, 1, 1}, {3, 1, 1});
  CHECK_THROWS_WITH(cdem::Simulation(plain, 1, nullptr), Contains("none of its cuts has a name"));
  cdem::ModelSpec held = bar(false, cdem::Element::small_strain);
  held.bodies[0].shape = cut_at(held.bodies[0].shape, 0.5, "outline", true);
  held.bodies[0].set_joints["outline"] = rock_joint();
  CHECK_THROWS_WITH(cdem::Simulation(held, 1, nullptr), Contains("a cut that is not glued"));
}

TEST_CASE("a law that varies from place to place holds each interface by its own", "[joint_sets]") {
  // A bar of six blocks along x; the joint at x bears x MPa.
  cdem::BodySpec body;
  body.name = "bar";
  body.shape = geom::grid({6, 1, 1}, {6, 1, 1});
  body.material = rock();
  body.joint = with_strength(3e6);
  body.joint_at = [](const geom::Vec3& x) { return with_strength(1e6 * x.x()); };
  body.element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  cdem::ModelSpec spec;
  spec.bodies = {body};
  const cdem::Model model = cdem::first_model(spec);
  REQUIRE(model.interfaces.size() == 5);
  for (const cdem::Interface& i : model.interfaces)
    CHECK(cdem::joint_of(model, i).tensile_strength ==
          Approx(1e6 * model.point_position[i.point_begin].x()).epsilon(1e-12));
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  const auto broken_under = [&](double stress) {
    s.clear_loads();
    s.traction(traction(cdem::Selection::side("x+"), {stress, 0, 0}));
    cdem::RelaxOptions options;
    options.max_steps = 2000;
    s.relax(options);
    return s.counts().broken_tension;
  };
  CHECK(broken_under(0.9e6) == 0);
  CHECK(broken_under(1.2e6) == s.counts().bonds / 5); // the first joint only, which then carries nothing on
}

// Rows of three blocks, parted by a dry cut of 30 degrees; what holds the blocks of a row is told by `rest`.
cdem::Simulation rows(const cdem::Joint& rest) {
  cdem::BodySpec body;
  body.name = "rows";
  geom::PlaneCutOptions options;
  options.name = "shear";
  body.shape = geom::cut_by_plane(geom::grid({0.75, 0.25, 0.5}, {3, 1, 1}),
                                  geom::Plane::through({0, 0, 0.25}, {0, 0, 1}), options);
  body.material = rock();
  body.material.youngs_modulus = 10e9;
  body.joint = rest;
  cdem::Joint dry;
  dry.bonded = false;
  dry.friction_angle = 30 * degree;
  dry.normal_stiffness = dry.shear_stiffness = 20e9;
  body.set_joints["shear"] = dry;
  cdem::ModelSpec spec;
  spec.bodies = {body};
  return cdem::Simulation(spec, 1, nullptr);
}

TEST_CASE("blocks that slide along a cut onto others keep the friction of the cut", "[joint_sets]") {
  cdem::Joint weak = with_strength(50e6);
  weak.friction_angle = 10 * degree;
  const cdem::Joint rest = GENERATE_COPY(cdem::glued_joint(), weak);
  cdem::Simulation s = rows(rest);
  const cdem::Selection top = cdem::Selection::in_box({{0, 0, 0.26}, {0.75, 0.25, 0.5}});
  s.fix(fixed(cdem::Selection::side("z-")));
  s.fix(fixed(cdem::Selection::side("y-"), "y"));
  s.fix(fixed(cdem::Selection::side("y+"), "y"));
  s.traction(traction(cdem::Selection::side("z+"), {0, 0, -1e6}));
  const auto push = [&](double by, int times) {
    for (int i = 0; i < times; ++i) {
      cdem::Fix pushed = fixed(top, "x");
      pushed.displacement = {s.mean("displacement.x", top) + by, 0, 0};
      s.fix(pushed);
      cdem::RelaxOptions options;
      options.residual = 1e-5;
      s.relax(options);
    }
  };
  push(1e-3, 20);
  push(2e-5, 10); // friction follows the last increments
  const Vec3 bears = s.reaction(cdem::Selection::side("z-"));
  CHECK(-bears.x() / bears.z() == Approx(std::tan(30 * degree)).epsilon(0.02));
}

TEST_CASE("blocks that part where the law varies meet with the friction it had there", "[joint_sets]") {
  cdem::BodySpec body;
  body.name = "rock";
  body.shape = geom::grid({4, 1, 1}, {4, 1, 1});
  body.material = rock();
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = 20 * degree;
  body.joint = joint;
  body.joint_at = [joint](const geom::Vec3& x) {
    cdem::Joint own = joint;
    own.friction_angle = 10 * degree * x.x();
    return own;
  };
  cdem::ModelSpec spec;
  spec.bodies = {body};
  const cdem::Model model = cdem::first_model(spec);
  for (const cdem::Interface& i : model.interfaces) {
    const auto left = model.surface.left_by.find(i.joint);
    REQUIRE(left != model.surface.left_by.end());
    CHECK(model.joints[left->second].friction_angle ==
          Approx(10 * degree * model.point_position[i.point_begin].x()));
  }
}
