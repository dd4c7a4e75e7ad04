// Convex blocks that move far: bonded they behave as blocks of small strain do, turned they feel nothing, and loose they
// fall, meet what they never touched before, and stay outside of it.
#include "libcdem/bond/release.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::BodySpec moving(std::string name, geom::Assembly shape, const cdem::Elastic& material = rock(),
                      const cdem::Joint& joint = rock_joint()) {
  cdem::BodySpec spec = body(std::move(name), std::move(shape), material, joint);
  spec.element = cdem::Element::finite_volume;
  return spec;
}

cdem::BodySpec rigid(std::string name, geom::Assembly shape) {
  cdem::BodySpec spec = body(std::move(name), std::move(shape));
  spec.element = cdem::Element::rigid;
  return spec;
}

geom::Assembly cells(int count, const Vec3& origin = {0, 0, 0}) {
  geom::VoronoiOptions options;
  options.count = count;
  options.origin = origin;
  return geom::voronoi(options);
}

double balance_of(const System& s) {
  return cdem::energy(s.model, s.state).balance_error();
}

} // namespace

TEST_CASE("bonded blocks that may move far deform under small loads as those of small strain do",
          "[moving]") {
  const auto pressed = [](const cdem::BodySpec& spec) {
    System s(build({spec}));
    s.hold(cdem::Selection::side("z-"), "xyz");
    s.conditions.tractions.push_back(traction(cdem::Selection::side("z+"), {3e4, 0, -1e5}));
    REQUIRE(s.relax(1e-9).converged);
    return s;
  };
  const System far = pressed(moving("rock", cells(30))), small = pressed(body("rock", cells(30)));
  REQUIRE(far.model.node_position.size() == small.model.node_position.size());
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < far.state.displacement.size(); ++i) {
    largest = std::max(largest, vec(small.state.displacement[i]).norm());
    difference =
        std::max(difference, (vec(far.state.displacement[i]) - vec(small.state.displacement[i])).norm());
  }
  CHECK(difference < 1e-4 * largest);
}

TEST_CASE("an assembly that has turned as a whole feels nothing", "[moving]") {
  System s(build({moving("rock", cells(30))}));
  const geom::Mat3 turn = rotation({1, 2, -0.5}, 130 * degree);
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.displacement[i] =
        node(turn * s.model.node_position[i] + Vec3(3, -20, 7) - s.model.node_position[i]);
  double largest = 0;
  for (const Vec3& f : s.net_forces())
    largest = std::max(largest, f.norm());
  CHECK(largest < 1e-10 * rock().youngs_modulus); // on faces of about 0.1 m2, springs of 50 E / h
}

TEST_CASE("a preload between blocks turns with them", "[moving]") {
  System s(build({moving("rock", geom::grid({1, 1, 2}, {1, 1, 2}))}));
  for (geom::Vec3& offset : s.state.bond_offset)
    offset = Vec3(1e-6, 0, -2e-6);
  const auto bond_forces = [&] { return s.net_forces(); };
  const std::vector<Vec3> before = bond_forces();
  const geom::Mat3 turn = rotation({1, 2, -0.5}, 130 * degree);
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.displacement[i] = node(turn * s.model.node_position[i] - s.model.node_position[i]);
  const std::vector<Vec3> after = bond_forces();
  double largest = 0, error = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    largest = std::max(largest, before[i].norm());
    error = std::max(error, (after[i] - turn * before[i]).norm());
  }
  REQUIRE(largest > 0);
  CHECK(error < 1e-8 * largest);
}

TEST_CASE("a block that slides off a ledge falls, lands on the floor and comes to rest there", "[moving]") {
  const bool deforms = GENERATE(true, false);
  cdem::BodySpec block =
      deforms ? moving("block", geom::grid({0.5, 0.5, 0.5}, {1, 1, 1}, {1.4, 0.25, 0}), soft_rock())
              : rigid("block", geom::grid({0.5, 0.5, 0.5}, {1, 1, 1}, {1.4, 0.25, 0}));
  System s(build({rigid("ledge", geom::grid({2, 1, 0.5}, {1, 1, 1}, {0, 0, -0.5})),
                  rigid("floor", geom::grid({30, 20, 0.5}, {1, 1, 1}, {-5, -10, -2})), block},
                 {{"ledge", "block", friction(20)}, {"floor", "block", friction(40)}}));
  s.hold(body_of("ledge"), "xyz");
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  const int moves = 2;
  for (int n = s.model.blocks[moves].node_begin; n < s.model.blocks[moves].node_end; ++n)
    s.state.velocity[n] = node({3, 0, 0});
  if (!deforms)
    s.state.rigid[s.model.blocks[moves].rigid].velocity = {3, 0, 0};
  cdem::RunOptions options;
  options.duration = deforms ? 3 : 6;
  options.local_damping = 0.05;
  double deepest = 0;
  options.callback_every = 200;
  options.callback = [&] { deepest = std::min(deepest, lowest(s, moves) + 1.5); };
  s.run(options);
  CHECK(centroid(s, moves).x() > 2);
  CHECK(lowest(s, moves) == Approx(-1.5).margin(2e-3));
  CHECK(deepest > -0.02);
}

TEST_CASE("a heap that falls apart on a floor stays above it, and its energy closes", "[moving]") {
  cdem::Joint weak = rock_joint();
  weak.cohesion = weak.tensile_strength = 2e3;
  System s(build({rigid("floor", geom::grid({6, 6, 0.5}, {1, 1, 1}, {-2.5, -2.5, -0.5})),
                  moving("heap", cells(12, {0, 0, 0.3}), soft_rock(), weak)},
                 {{"floor", "heap", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 1;
  options.safety = 0.5;
  s.run(options);
  const auto parted = std::count(s.state.released.begin(), s.state.released.end(), 1);
  CHECK(parted > 3);
  CHECK(balance_of(s) < 1e-2);
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b)
    if (s.model.blocks[b].body == 1)
      CHECK(lowest(s, b) > -0.01);
}

TEST_CASE("a block lands on a meshed body, and the other way round", "[moving]") {
  const bool block_below = GENERATE(false, true);
  const auto blocks = [](const Vec3& origin) {
    return moving("blocks", geom::grid({1, 1, 0.4}, {1, 1, 1}, origin), soft_rock());
  };
  const auto mesh = [](const Vec3& centre) {
    return meshed("mesh", box_at({0.8, 0.8, 0.4}, {3, 3, 2}, geom::Mat3::Identity(), centre), {},
                  soft_rock());
  };
  System s(build({block_below ? blocks({-0.5, -0.5, 0}) : blocks({-0.5, -0.5, 0.45}),
                  block_below ? mesh({0.03, 0.02, 0.65}) : mesh({0.03, 0.02, 0.2})},
                 {{"blocks", "mesh", friction(30)}}));
  s.hold(cdem::Selection::in_box({{-2, -2, -0.01}, {2, 2, 0.01}}), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 1;
  options.local_damping = 0.1;
  s.run(options);
  const int upper = block_below ? 1 : 0;
  CHECK(lowest(s, upper) == Approx(0.4).margin(2e-3));
}

TEST_CASE("blocks that move far end in the same bits for every number of threads", "[moving][threads]") {
  const auto hash_with = [](int threads) {
    cdem::Joint weak = rock_joint();
    weak.cohesion = weak.tensile_strength = 2e3;
    System s(build({rigid("floor", geom::grid({6, 6, 0.5}, {1, 1, 1}, {-2.5, -2.5, -0.5})),
                    moving("heap", cells(15, {0, 0, 0.05}), soft_rock(), weak)},
                   {{"floor", "heap", friction(30)}}));
    s.threads = threads;
    s.hold(body_of("floor"), "xyz");
    s.conditions.gravity = gravity();
    cdem::RunOptions options;
    options.duration = 0.2;
    s.run(options);
    return cdem::hash(s.state);
  };
  CHECK(hash_with(1) == hash_with(3));
}

namespace {

// A plate under uniaxial compression, as in Han 2010 example 4.1, coarser.
cdem::Simulation pressed_plate(cdem::Element element) {
  cdem::ModelSpec spec;
  spec.bodies = {body("plate", geom::grid({0.3, 0.3, 0.03}, {6, 6, 1}))};
  spec.bodies[0].element = element;
  cdem::Simulation s(spec, 1, nullptr);
  for (const char* side : {"z-", "z+"})
    s.fix(fixed(cdem::Selection::side(side), "z"));
  s.fix(fixed(cdem::Selection::side("y-")));
  s.fix(fixed(cdem::Selection::side("y+"), "xz"));
  s.traction(traction(cdem::Selection::side("y+"), {0, -30e6, 0}));
  cdem::RelaxOptions elastic;
  elastic.breaking = false;
  REQUIRE(s.relax(elastic).converged);
  return s;
}

} // namespace

TEST_CASE("blocks that may move far are cut where those of small strain are, without a kick",
          "[moving][cut]") {
  cdem::Simulation far = pressed_plate(cdem::Element::finite_volume),
                   small = pressed_plate(cdem::Element::small_strain);
  cdem::RefineOptions options;
  options.shear_threshold = 2e6;
  const double before = far.min("displacement.y").value;
  CHECK(before == Approx(small.min("displacement.y").value).epsilon(2e-3)); // strains of 1e-3
  const auto cuts = far.refine(options), expected = small.refine(options);
  REQUIRE(expected.size() > 4);
  REQUIRE(cuts.size() == expected.size());
  for (std::size_t i = 0; i < cuts.size(); ++i)
    CHECK(std::abs(cuts[i].normal.dot(expected[i].normal)) > 0.999);
  cdem::RelaxOptions elastic;
  elastic.breaking = false;
  REQUIRE(far.relax(elastic).converged);
  CHECK(far.min("displacement.y").value == Approx(before).epsilon(1e-2));
}

TEST_CASE("blocks that may move far keep an initial stress, and close in on a hole cut into it",
          "[moving][cut]") {
  cdem::ModelSpec spec;
  spec.bodies = {moving("rock", geom::grid({0.7, 0.1, 0.7}, {7, 1, 7}, {-0.35, 0, -0.35}))};
  cdem::Simulation s(spec, 1, nullptr);
  s.initial_stress(cdem::Selection::everything(), {-2e6, 0, -2e6, 0, 0, 0});
  for (const char* side : {"x-", "x+"})
    s.fix(fixed(cdem::Selection::side(side), "x"));
  for (const char* side : {"z-", "z+"})
    s.fix(fixed(cdem::Selection::side(side), "z"));
  s.fix(fixed(cdem::Selection::side("y-"), "y"));
  s.fix(fixed(cdem::Selection::side("y+"), "y"));
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  CHECK(s.max("displacement.magnitude").value < 1e-12);
  CHECK(s.remove(cdem::Selection::in_box({{-0.06, -1, -0.06}, {0.06, 1, 0.06}})) == 1);
  REQUIRE(s.relax(options).converged);
  const double left = s.at("displacement.x", {-0.051, 0.05, 0}),
               right = s.at("displacement.x", {0.051, 0.05, 0});
  CHECK(left > 0.5 * 2e6 / rock().youngs_modulus * 0.05);
  CHECK(right == Approx(-left).epsilon(1e-4));
}

TEST_CASE("blocks: two that meet face on at the default time step keep their energy", "[blocks][contact]") {
  // Contacts of blocks are as stiff as their joints, far stiffer than the blocks: a step for the blocks alone would throw
  // them apart with hundreds of times the energy they came with.
  const auto cube = [](const char* name, double x) {
    cdem::BodySpec body{name, {}, rock(), friction(30)};
    body.shape.blocks = {geom::make_box({x, 0, 0}, {x + 0.4, 0.4, 0.4})};
    return body;
  };
  cdem::Simulation s({{cube("a", 0), cube("b", 0.401)}, {{"a", "b", friction(30)}}}, 1, nullptr);
  s.initial_velocity(cdem::Selection::of_body("a"), {0.5, 0, 0});
  cdem::RunOptions options;
  options.duration = 0.01;
  s.run(options);
  CHECK(s.contacts().deepest > 0);
  CHECK(s.energy().balance_error() < 0.05);
  CHECK(s.mean("velocity.x", cdem::Selection::of_body("b")) == Approx(0.5).epsilon(0.2));
}
