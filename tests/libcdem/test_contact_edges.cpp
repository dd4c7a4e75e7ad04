// Contact where edges and corners meet: they carry on over nodes, and blocks in rows do not feel those across them.
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/results/energy.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

#include <functional>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

// Moves the upper body as it is. pace: m/s; step: s, at most.
void move_upper(System& s, const Vec3& way, std::int64_t every, std::function<void()> look, double pace = 0.5,
                double step = 2e-6) {
  cdem::Fix fix = fixed(body_of("upper"));
  fix.velocity = pace * way.normalized();
  s.conditions.fixes.push_back(fix);
  const double duration = way.norm() / pace;
  cdem::RunOptions options;
  options.steps = std::lround(std::ceil(duration / step - 1e-6));
  options.time_step = duration / static_cast<double>(options.steps);
  options.callback_every = every;
  options.callback = std::move(look);
  s.run(options);
  s.conditions.fixes.pop_back();
}

} // namespace

TEST_CASE("contact: an edge pressed on another carries on over the nodes of both", "[contact][edges]") {
  // Two bars on edge, crossed, moved as they are: pressed together by d, then along the bisector over four nodes of each.
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0);
  const double phi = GENERATE(0.0, 20.0);
  cdem::Joint law = friction(phi);
  law.shear_stiffness = 1e9;
  System s(build({meshed("lower", box_at({0.9, 0.3, 0.3}, {9, 2, 2}, rotation({1, 0, 0}, 45 * degree),
                                         {0.43, 0.43, -across})),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2}, rotation({0, 1, 0}, 45 * degree),
                                         {0.24, 0.26, across + gap}))},
                 {{"lower", "upper", law}}));
  s.hold(body_of("lower"), "xyz");
  const auto move = [&](const Vec3& way) {
    std::vector<double> forces;
    const auto look = [&] {
      Vec3 force = Vec3::Zero();
      for (const cdem::Contact& c : s.state.contacts)
        force +=
            (cdem::blocks_of(s.model, c).first == 1 ? 1 : -1) * (normal_force(s, c) * c.normal + c.shear);
      forces.push_back(force.norm());
    };
    move_upper(s, way, 5, look, 2); // 4e-6 m a step
    return forces;
  };
  const double pressed = move({0, 0, -gap - d}).back();
  REQUIRE(pressed > 0);
  const std::vector<double> forces = move({0.41, 0.37, 0});
  // Until it slides friction grows. Beside a node, as far as the edges are pressed, the semi-springs there act too.
  const double slides = pressed * std::sqrt(1 + std::pow(std::tan(phi * degree), 2));
  int odd = 0;
  for (const double force : forces) {
    CHECK(force > 0.99 * pressed);
    CHECK(force < 3 * slides);
    odd += force > 1.01 * slides;
  }
  CHECK(odd < 0.02 * static_cast<double>(forces.size()));
}

TEST_CASE("contact: an edge pressed on a bent one carries on over its nodes, bent outwards and inwards",
          "[contact][edges]") {
  // The lower ridge goes up and down by a kink at every node; the upper one is moved along it, d below it.
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0), slice = 0.1;
  const double kink = GENERATE(1e-5, 0.008, 0.6); // rad
  const double turn = GENERATE(0.0, -35.0, 45.0) * degree;
  const double sideways = GENERATE(0.0, 0.5); // the upper one's nodes pass, too
  const double rise = 0.5 * slice * std::tan(0.5 * kink);
  const auto height = [&](double x) { // of the ridge
    const double part = x / slice - std::floor(x / slice);
    const double up = rise * (2 * part - 1);
    return static_cast<int>(std::floor(x / slice)) % 2 == 0 ? up : -up;
  };
  geom::TetMesh bent =
      box_at({0.9, 0.3, 0.3}, {9, 2, 2}, rotation({1, 0, 0}, 45 * degree), {0.45, 0.02, -across});
  for (Vec3& x : bent.nodes)
    x.z() += height(x.x() + 1e-9);
  const double start = 0.25;
  System s(build({meshed("lower", bent),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2},
                                         rotation({0, 0, 1}, turn) * rotation({0, 1, 0}, 45 * degree),
                                         {start, 0.02, across + gap + height(start)}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  double least = 1e30, most = 0, latest = 0;
  int not_one = 0;
  const auto look = [&] {
    double force = 0;
    int edges = 0;
    for (const cdem::Contact& c : s.state.contacts) {
      force += normal_force(s, c);
      latest = std::max(latest, c.reference_penetration);
      edges += c.kind == cdem::Contact::edge ? 1 : 0;
    }
    not_one += edges == 1 ? 0 : 1;
    least = std::min(least, force);
    most = std::max(most, force);
  };
  move_upper(s, {0, 0, -gap - d}, 1000000, [] {});
  look();
  const double pressed = least, stored = cdem::contact_energy(s.model, s.state, 0);
  REQUIRE(pressed > 0);
  double x = start, z = height(start);
  const auto cross_to = [&](double to, double pace) {
    const double way = to - x; // of the crossing
    move_upper(s, {way * (1 - sideways * std::tan(turn)), way * sideways, height(to - 1e-9) - z}, 1, look,
               pace);
    x = to;
    z = height(to - 1e-9);
  };
  for (const double ridge_node : {0.3, 0.4, 0.5, 0.6}) {
    cross_to(ridge_node - 5e-4, 25);
    cross_to(ridge_node, 1); // 2 um a step
    cross_to(ridge_node + 5e-4, 1);
  }
  CHECK(not_one == 0);
  // Depth is that below the ridge, which is inclined, and over a node bent inwards the way to the node.
  CHECK(least > (1 - 0.1 * kink) * pressed);
  CHECK(most < (1 + 0.2 * kink) * pressed);
  CHECK(latest < 0.01 * d);
  CHECK(s.state.spent.friction < 1e-3 * stored);
}

TEST_CASE("contact: an edge led off the end of another lets go, however short the last of its edges is",
          "[contact][edges]") {
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0), last = GENERATE(0.1, 0.005, 0.001);
  geom::TetMesh lower =
      box_at({0.9, 0.3, 0.3}, {9, 2, 2}, rotation({1, 0, 0}, 45 * degree), {-0.45, 0.02, -across});
  for (Vec3& x : lower.nodes)
    if (std::abs(x.x() + 0.1) < 1e-6)
      x.x() = -last;
  System s(build({meshed("lower", lower),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2}, rotation({0, 1, 0}, 45 * degree),
                                         {-0.05, 0, across + gap}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  std::size_t contacts = 0;
  const auto move = [&](const Vec3& way) {
    contacts = 0;
    move_upper(
        s, way, 1, [&] { contacts += s.state.contacts.size(); }, 20, 1.5e-7);
    return s.state.contacts.size();
  };
  REQUIRE(move({0, 0, -gap - d}) == 1);
  CHECK(move({0.0495, 0, 0}) == 1);
  move({0.001, 0, 0});
  move({0.02, 0, 0});
  CHECK(contacts == 0);
}

TEST_CASE("contact: a ridge whose end is drawn over the edge of a box is not held back there",
          "[contact][edges]") {
  // A bar lies with its ridge on the top of a box, and reaches over its edge.
  const double d = 2e-4, gap = 1e-4, across = 0.1 * std::sqrt(2.0);
  System s(build({meshed("lower", box_at({1, 1, 0.5}, {2, 2, 1}, Mat3::Identity(), {-0.5, 0.02, -0.25})),
                  meshed("upper", box_at({0.9, 0.2, 0.2}, {5, 1, 1}, rotation({1, 0, 0}, 45 * degree),
                                         {-0.4, 0, across + gap}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  double upwards = 0, along = 0; // N, the largest
  const auto look = [&] {
    Vec3 force = Vec3::Zero();
    for (const cdem::Contact& c : s.state.contacts)
      force += (cdem::blocks_of(s.model, c).first == 1 ? 1 : -1) * normal_force(s, c) * c.normal;
    upwards = std::max(upwards, force.z());
    along = std::max(along, std::abs(force.x()));
  };
  move_upper(s, {0, 0, -gap - d}, 50, look);
  REQUIRE(upwards > 0);
  move_upper(s, {-0.06, 0, 0}, 50, look, 2); // 0.01 m too far
  CHECK(along < 1e-3 * upwards);
}

TEST_CASE("contact: an edge across a corner of an outline presses on both sides of it", "[contact][edges]") {
  // The plate's outline is bent by 28 degrees in its plane: a straight edge crosses it twice, in and out again.
  const double d = 2e-4, gap = 1e-4, slope = 0.25, at = 0.16;
  geom::TetMesh plate = box_at({0.8, 0.3, 0.3}, {2, 2, 2}, Mat3::Identity(), {0, 0, -0.15});
  for (Vec3& x : plate.nodes)
    x.y() -= slope * std::abs(x.x());
  System s(build({meshed("plate", plate),
                  meshed("upper", box_at({0.9, 0.3, 0.3}, {1, 2, 2}, rotation({1, 0, 0}, 45 * degree),
                                         {0, 0.15 - slope * at, 0.3 / std::sqrt(2.0) + gap}))},
                 {{"plate", "upper", friction(0)}}));
  s.hold(body_of("plate"), "xyz");
  move_upper(s, {0, 0, -gap - d}, 1000000, [] {});
  REQUIRE(s.state.contacts.size() == 2);
  for (const cdem::Contact& c : s.state.contacts) {
    CHECK(c.kind == cdem::Contact::edge);
    CHECK(c.depth == Approx(d).epsilon(0.01));
    CHECK(c.reference_penetration == 0);
  }
}

TEST_CASE("contact: bent edges that hit each other beside their nodes let go without loss",
          "[contact][edges]") {
  // Rigid, each bent by 10 degrees outwards or inwards in the middle. All that is lost is stored and let go elsewhere.
  const double bend = GENERATE(10.0, -10.0) * degree, turn = GENERATE(40.0, 75.0) * degree;
  const Vec3 off = GENERATE(Vec3(0.003, 0.001, 0), Vec3(-0.002, 0.0005, 0)), velocity(1, 0.4, -1);
  const auto bar = [&](const Mat3& attitude, const Vec3& at, double side) {
    geom::TetMesh mesh = box_at({2, 0.2, 0.2}, {2, 1, 1}, rotation({1, 0, 0}, 45 * degree), {0, 0, 0});
    for (Vec3& x : mesh.nodes)
      x.z() -= side * std::tan(0.5 * bend) * std::abs(x.x());
    return placed(mesh, attitude, at);
  };
  const double apart = 0.2 * std::sqrt(2.0) + 1e-3;
  std::vector<cdem::BodySpec> bodies{
      meshed("lower", bar(Mat3::Identity(), {0, 0, 0}, 1)),
      meshed("upper", bar(rotation({0, 0, 1}, turn), off + Vec3(0, 0, apart), -1))};
  for (cdem::BodySpec& body : bodies)
    body.element = cdem::Element::rigid;
  System s(build(bodies, {{"lower", "upper", friction(0)}}));
  s.state.rigid[1].velocity = {velocity.x(), velocity.y(), velocity.z()};
  const double kinetic = 0.5 * s.model.rigid[1].mass * velocity.squaredNorm();
  cdem::RunOptions options;
  options.duration = 0.01;
  double deepest = 0;
  options.callback_every = 1;
  options.callback = [&] {
    for (const cdem::Contact& c : s.state.contacts)
      deepest = std::max(deepest, c.depth);
  };
  s.run(options);
  CHECK(deepest > 0);
  CHECK(s.state.contacts.empty());
  CHECK(s.state.spent.friction < 0.01 * kinetic);
}

TEST_CASE("contact: edges beside the nodes of two bent ridges press the more the deeper they are",
          "[contact][edges]") {
  // Roofs 0.6 m high, both bent in plan and upwards, that cross at 20 degrees some millimetres beside their nodes: edges
  // that follow on both are near, and apart.
  const auto roof = [](const std::array<Vec3, 3>& ridge, const Vec3& across, const Vec3& down) {
    geom::TetMesh mesh = geom::box_mesh({2, 2, 1}, {2, 2, 1});
    for (Vec3& x : mesh.nodes) {
      const double side = std::round(x.y()) - 1.0;
      x = ridge[std::lround(x.x())] + side * across + (x.z() > 0.5 ? 0.6 * std::abs(side) : 1.0) * down;
    }
    return mesh;
  };
  System s(build(
      {meshed("lower",
              roof({Vec3(-0.980751, 0.070889, -0.181938), Vec3(0, 0, 0), Vec3(0.980751, 0.070889, -0.181938)},
                   Vec3::UnitY(), -Vec3::UnitZ())),
       meshed("upper", roof({Vec3(-0.968527, -0.125531, -0.209118), Vec3(0.000848, 0.001054, 0.001331),
                             Vec3(0.820639, 0.533645, -0.209118)},
                            Vec3(0.345710, -0.938341, 0), Vec3::UnitZ()))},
      {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  double last = 0;
  int falls = 0;
  move_upper(s, {0, 0, -3e-3}, 1, [&] {
    double force = 0;
    for (const cdem::Contact& c : s.state.contacts)
      force += normal_force(s, c);
    falls += force < 0.999 * last ? 1 : 0;
    last = force;
  });
  CHECK(last > 0);
  CHECK(falls == 0);
  CHECK(s.state.spent.friction < 1e-6 * cdem::contact_energy(s.model, s.state, 0));
}

TEST_CASE("contact: over nodes of uneven edges what is stored goes on or is lost, and never grows",
          "[contact][edges]") {
  // The lower bar's slices are 0.04 and 0.16 long in turn: soft and stiff edges.
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0);
  geom::TetMesh uneven = geom::box_mesh({0.9, 0.3, 0.3}, {9, 2, 2});
  for (Vec3& x : uneven.nodes) {
    const auto slice = static_cast<int>(std::lround(x.x() / 0.1));
    x = Vec3(0.2 * (slice / 2) + (slice % 2) * 0.04, x.y(), x.z()) - Vec3(0.45, 0.15, 0.15);
  }
  System s(build({meshed("lower", placed(uneven, rotation({1, 0, 0}, 45 * degree), {0.43, 0.43, -across})),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2}, rotation({0, 1, 0}, 45 * degree),
                                         {0.24, 0.26, across + gap}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  std::vector<double> stored, friction_taken;
  std::size_t most = 0;
  const auto move = [&](const Vec3& way) {
    move_upper(s, way, 20, [&] {
      stored.push_back(cdem::contact_energy(s.model, s.state, 0));
      friction_taken.push_back(s.state.spent.friction);
      most = std::max(most, s.state.contacts.size());
    });
  };
  move({0, 0, -gap - d});
  const double before = stored.back(), taken = friction_taken.back();
  stored.clear();
  friction_taken.clear();
  most = 0;
  move({0.41, 0, 0});
  REQUIRE(most == 1);
  double least = before;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    CHECK(stored[i] <
          least * (1 + 1e-6)); // it falls where the next edge could store it only deeper than it is
    least = std::min(least, stored[i]);
    CHECK(stored[i] + friction_taken[i] - taken == Approx(before).epsilon(1e-6));
  }
  CHECK(least > 0.05 * before);
  CHECK(least < 0.7 * before);
}

TEST_CASE("contact: edges pressed deep carry on, and end the run as too deep", "[contact][edges]") {
  const double half = std::sqrt(0.5) * 0.4;
  const Mat3 on_edge = rotation({1, 0, 0}, 45 * degree);
  System s(build({meshed("lower", box_at({3, 0.4, 0.4}, {4, 1, 1}, on_edge, {0, 0, 0})),
                  meshed("upper", box_at({3, 0.4, 0.4}, {4, 1, 1}, rotation({0, 0, 1}, 75 * degree) * on_edge,
                                         {0.21, 0.17, 2 * half}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  cdem::Fix down = fixed(body_of("upper"));
  down.velocity = Vec3(0, 0, -1);
  s.conditions.fixes.push_back(down);
  double last = 0;
  cdem::RunOptions options;
  options.duration = 0.2;
  options.callback_every = 20;
  options.callback = [&] {
    double sum = 0;
    for (const cdem::Contact& c : s.state.contacts)
      sum += normal_force(s, c);
    CHECK(sum > 0.999 * last);
    last = sum;
  };
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("of a tet's height"));
  CHECK(s.state.time == Approx(0.25 * 0.4).epsilon(0.01)); // at a quarter of the height
}
