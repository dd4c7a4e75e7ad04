// A heap of rigid convex blocks: how far two of them have moved relative to each other, and that pairs of blocks that are
// skipped change no bit.
#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/random.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

struct Motion {
  cdem::BodyPose pose;

  Eigen::Quaterniond rotation() const {
    const auto& q = pose.rotation;
    return {q[0], q[1], q[2], q[3]};
  }
  Vec3 at(const Vec3& offset) const { return pose.centre + rotation() * offset; }
  Vec3 seen(const Vec3& x) const { return rotation().conjugate() * (x - pose.centre); }
  void move(const Vec3& shift, const Vec3& angle) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle.norm(), angle.normalized())),
        now = turn * rotation();
    pose.rotation = {now.w(), now.x(), now.y(), now.z()};
    pose.centre = turn * pose.centre + shift;
  }
};

// Each time another one, in a cube of this half side.
Vec3 any(double at_most) {
  static std::uint64_t draw = 0;
  ++draw;
  return at_most * Vec3(2 * geom::uniform(7, 0, draw) - 1, 2 * geom::uniform(7, 1, draw) - 1,
                        2 * geom::uniform(7, 2, draw) - 1);
}

cdem::Elastic soft_stone() {
  cdem::Elastic stone = rock();
  stone.youngs_modulus = 2e8;
  return stone;
}

geom::Assembly cells(const Vec3& size, int count, const Vec3& corner) {
  geom::VoronoiOptions options;
  options.size = size;
  options.count = count;
  options.origin = corner;
  return geom::voronoi(options);
}

// Rigid bodies with friction on each other.
cdem::ModelSpec rigid(std::vector<cdem::BodySpec> bodies) {
  cdem::ModelSpec spec;
  spec.bodies = std::move(bodies);
  for (cdem::BodySpec& each : spec.bodies)
    each.element = cdem::Element::rigid;
  for (std::size_t a = 0; a < spec.bodies.size(); ++a)
    for (std::size_t b = a; b < spec.bodies.size(); ++b)
      spec.pairs.push_back({spec.bodies[a].name, spec.bodies[b].name, friction(20)});
  return spec;
}

struct Outcome {
  std::uint64_t hash = 0;
  std::size_t contacts = 0; // at most
  double open = 0;          // of the energy balance, over the energy at the beginning
};

struct Case {
  cdem::ModelSpec spec;
  std::function<void(System&)> push; // gives it its velocities
  int steps = 0;
};

Outcome fall(const Case& c, int threads, bool looks_at_all) {
  System s(cdem::first_model(c.spec));
  s.threads = threads;
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  c.push(s);
  cdem::RunOptions options;
  options.steps = c.steps;
  options.safety = 0.4;
  options.looks_at_all_contacts = looks_at_all;
  options.callback_every = 50;
  Outcome outcome;
  options.callback = [&] { outcome.contacts = std::max(outcome.contacts, s.state.contacts.size()); };
  const double given = cdem::energy(s.model, s.state).total();
  s.run(options);
  outcome.hash = cdem::hash(s.state);
  const cdem::EnergyLedger energy = cdem::energy(s.model, s.state);
  outcome.open = std::abs(energy.total() - energy.external - given) / given;
  return outcome;
}

cdem::RigidState& state_of(System& s, const std::string& body) {
  for (std::size_t i = 0; i < s.model.rigid.size(); ++i)
    if (s.model.bodies[s.model.blocks[s.model.rigid[i].block].body].name == body)
      return s.state.rigid[i];
  throw std::logic_error("no rigid body " + body);
}

void require_same_bits(const Case& c, std::size_t contacts) {
  const Outcome all = fall(c, 1, true);
  CHECK(all.contacts >= contacts);
  CHECK(all.open < 0.01);
  CHECK(fall(c, 1, false).hash == all.hash);
  CHECK(fall(c, 3, false).hash == all.hash);
}

} // namespace

TEST_CASE("no place of a body moves further relative to another than their poses tell", "[contact]") {
  for (int trial = 0; trial < 200; ++trial) {
    Motion a, b;
    a.move(any(3), any(2));
    b.move(any(3), any(2));
    const Motion a0 = a, b0 = b;
    const double size = std::pow(10., -(trial % 7)), radius = 0.5;
    a.move(any(size), any(size));
    b.move(any(size), any(size));
    const double bound =
        cdem::motion_between(cdem::seen_from(a.pose, b.pose), cdem::seen_from(a0.pose, b0.pose), radius);
    double largest = 0;
    for (int i = 0; i < 100; ++i) {
      const Vec3 offset = radius * any(1).normalized();
      largest = std::max(largest, (a.seen(b.at(offset)) - a0.seen(b0.at(offset))).norm());
    }
    CHECK(largest <= bound);
    CHECK(bound <= 6 * largest);
  }
}

TEST_CASE("a block turns by no more than its nodes move over the radius of a ball within it", "[contact]") {
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 half = any(1).cwiseAbs() + Vec3(0.01, 0.01, 0.01); // of a box
    Motion box;
    box.move(any(3), any(2));
    const Motion before = box;
    box.move(any(std::pow(10., -(trial % 7))), any(std::pow(10., -(trial % 5))));
    double path = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 offset =
          half.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
      path = std::max(path, (box.at(offset) - before.at(offset)).norm());
    }
    const double angle = box.rotation().angularDistance(before.rotation());
    CHECK(2 * std::sin(angle / 2) <= path / half.minCoeff() * (1 + 1e-9) + 1e-12);
  }
}

TEST_CASE("two bodies that move together are at rest for each other", "[contact]") {
  Motion a, b;
  a.move({1, 2, 3}, {0.1, 0.2, 0.3});
  b.move({1.5, 2, 3}, {-1, 0.4, 0.1});
  const cdem::BodyPose before = cdem::seen_from(a.pose, b.pose);
  for (Motion* each : {&a, &b})
    each->move({7, -3, 2}, {0.5, 1, -2});
  CHECK(cdem::motion_between(cdem::seen_from(a.pose, b.pose), before, 0.5) < 1e-10);
}

TEST_CASE("a heap of rigid blocks that falls and slides: pairs that are skipped change no bit",
          "[contact][moving]") {
  Case c;
  c.spec = rigid(
      {body("heap", cells({0.4, 0.4, 0.3}, 10, {0, 0, 0}), soft_stone(), friction(20)),
       body("floor", geom::grid({2, 2, 0.2}, {1, 1, 1}, {-0.8, -0.8, -0.201}), soft_stone(), friction(20))});
  c.steps = 2500;
  c.push = [](System& s) {
    for (std::size_t i = 0; i < s.model.rigid.size(); ++i)
      if (const int block = s.model.rigid[i].block;
          s.model.bodies[s.model.blocks[block].body].name == "heap") {
        const Vec3 away = centroid(s, block) - Vec3(0.2, 0.2, 0);
        s.state.rigid[i].velocity = {2 + 4 * away.x(), 4 * away.y(), -1};
      }
  };
  require_same_bits(c, 30);
}

TEST_CASE("a heap that strikes a tilted floor: pairs that are skipped change no bit", "[contact][moving]") {
  const geom::Mat3 tilt = (Eigen::AngleAxisd(0.5, Vec3(1, 2, 0.3).normalized())).toRotationMatrix();
  geom::Assembly floor = geom::grid({3, 3, 0.2}, {1, 1, 1}, {-1.5, -1.5, -0.2});
  for (geom::Polyhedron& block : floor.blocks)
    for (Vec3& x : block.vertices)
      x = tilt * x + Vec3(0, 0, -0.12);
  Case c;
  c.spec = rigid({body("heap", cells({0.3, 0.3, 0.3}, 6, {-0.15, -0.15, 0}), soft_stone(), friction(20)),
                  body("floor", floor, soft_stone(), friction(20))});
  c.steps = 3000;
  c.push = [](System& s) {
    for (std::size_t i = 0; i < s.model.rigid.size(); ++i)
      if (const int block = s.model.rigid[i].block; s.model.bodies[s.model.blocks[block].body].name == "heap")
        s.state.rigid[i].velocity = cdem::three_of(4 * centroid(s, block) + Vec3(0, 0, -8));
  };
  require_same_bits(c, 5);
}

TEST_CASE("a plate that spins fast past a block knocks it over: pairs that are skipped change no bit",
          "[contact][moving]") {
  Case c;
  c.spec = rigid({body("plate", geom::grid({1.2, 0.2, 0.1}, {1, 1, 1}, {-0.6, -0.1, 0.15}), soft_stone()),
                  body("block", geom::grid({0.2, 0.2, 0.3}, {1, 1, 1}, {0.25, 0.15, 0.0005}), soft_stone()),
                  body("floor", geom::grid({4, 4, 0.2}, {1, 1, 1}, {-2, -2, -0.2}), soft_stone())});
  c.steps = 3000;
  c.push = [](System& s) {
    cdem::RigidState& plate = state_of(s, "plate");
    const double mass = 1.2 * 0.2 * 0.1 * s.model.bodies[0].material.density;
    plate.angular_momentum = {0, 0, mass * (1.2 * 1.2 + 0.2 * 0.2) / 12 * 30}; // 30 rad/s
  };
  require_same_bits(c, 2);
}
