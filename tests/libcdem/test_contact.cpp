// Contact between meshed bodies: an incline, a drop, momentum, energy, bits.
#include "libcdem/results/energy.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libcdem/boxes.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

// A flat block on a plate, both level; gravity is turned instead. The law is that of a rigid block: the contact's
// period is 20 times the block's own.
System block_on_plate(double size, double friction_angle, double slope) {
  cdem::Joint law = friction(friction_angle);
  const double own_period = 2 * size / std::sqrt(rock().youngs_modulus / rock().density);
  // Both sides bring their springs.
  law.normal_stiffness = rock().density * 0.3 * size * std::pow(2 * pi / (20 * own_period), 2);
  System s(build(
      {meshed("plate", box_at({3 * size, 2 * size, 0.4 * size}, {6, 4, 1}, Mat3::Identity(),
                              {0.7 * size, 0, -0.2 * size})),
       meshed("block", box_at({size, size, 0.3 * size}, {3, 3, 1}, Mat3::Identity(), {0, 0, 0.15 * size}))},
      {{"plate", "block", law}}));
  s.hold(body_of("plate"), "xyz");
  s.conditions.gravity = gravity(9.81 * Vec3(std::sin(slope * degree), 0, -std::cos(slope * degree)));
  return s;
}

} // namespace

TEST_CASE("contact: a block on an incline slides at g (sin a - tan(phi) cos a)", "[contact]") {
  const double size = GENERATE(1.0, 0.1, 0.01);
  System s = block_on_plate(size, 20, 35);
  s.hold(body_of("block"), "x");
  REQUIRE(s.relax(1e-8).converged); // pressed against the plate by its weight, then let go
  s.conditions.fixes.pop_back();
  const double a = 9.81 * (std::sin(35 * degree) - std::tan(20 * degree) * std::cos(35 * degree));
  // As if it had come from rest over 2 % of its length.
  const double before = std::sqrt(2 * a * 0.02 * size), x0 = centroid(s, 1).x();
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 1)
      s.state.velocity[i] = node({before, 0, 0});
  cdem::RunOptions options;
  const double time = 3 * before / a;
  options.duration = time;
  s.run(options);
  // Over edges of triangles on both sides.
  CHECK(centroid(s, 1).x() - x0 == Approx(before * time + 0.5 * a * time * time).epsilon(0.005));
}

TEST_CASE("contact: a block on an incline sticks below the friction angle", "[contact]") {
  const double size = GENERATE(1.0, 0.1, 0.01);
  System s = block_on_plate(size, 20, 15);
  REQUIRE(s.relax(1e-8).converged);
  const double x1 = centroid(s, 1).x();
  cdem::RunOptions options;
  options.steps = 20000;
  s.run(options);
  CHECK(std::abs(centroid(s, 1).x() - x1) < 1e-6 * size);
  CHECK(std::abs(centroid(s, 1).x()) < 1e-4 * size);
}

TEST_CASE("contact: dropped without damping, a body comes back to its height", "[contact]") {
  // The contact's period is many times the body's own: nothing is left in vibration.
  cdem::Joint joint = friction(30);
  joint.normal_stiffness = 2e7;
  const double height = 0.05;
  System s(build({meshed("plate", box_at({3, 3, 0.4}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("block", box_at({1, 1, 1}, {2, 2, 2}, Mat3::Identity(), {0, 0, 0.5 + height}))},
                 {{"plate", "block", joint}}));
  s.hold(body_of("plate"), "xyz");
  s.conditions.gravity = gravity();
  const double start = centroid(s, 1).z();
  double highest = 0;
  bool landed = false;
  cdem::RunOptions options;
  options.duration = 4.4 * std::sqrt(2 * height / 9.81);
  options.callback_every = 20;
  options.callback = [&] {
    landed = landed || centroid(s, 1).z() < 0.5;
    if (landed)
      highest = std::max(highest, centroid(s, 1).z());
  };
  s.run(options);
  REQUIRE(landed);
  CHECK(highest - 0.5 == Approx(height).epsilon(0.005));
  CHECK(start - 0.5 == Approx(height));
  const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
  CHECK(std::abs(ledger.total() - ledger.external) < 1e-3 * ledger.external_peak);
}

// Contacts of one triangle with two bodies are found body by body, in either order; none of them is lost.
TEST_CASE("contact: a plank on two blocks swings, and the ledger closes", "[contact]") {
  const double side = GENERATE(-1.0, 1.0);
  cdem::Joint joint = friction(0);
  joint.normal_stiffness = 2e7;
  System s(build({meshed("one", box_at({0.6, 1.2, 0.4}, {1, 1, 1}, Mat3::Identity(), {side, 0, -0.2})),
                  meshed("other", box_at({0.6, 1.2, 0.4}, {1, 1, 1}, Mat3::Identity(), {-side, 0, -0.2})),
                  meshed("plank", box_at({2.4, 1, 0.5}, {1, 1, 1}, Mat3::Identity(), {0, 0, 0.25 + 1e-4}))},
                 {{"one", "plank", joint}, {"other", "plank", joint}}));
  s.hold(body_of("one"), "xyz");
  s.hold(body_of("other"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 0.1;
  options.callback_every = 20;
  std::size_t most = 0;
  options.callback = [&] { most = std::max(most, s.state.contacts.size()); };
  s.run(options);
  REQUIRE(most >= 4);
  const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
  CHECK(std::abs(ledger.total() - ledger.external) < 1e-3 * ledger.external_peak);
}

TEST_CASE("contact: bodies that collide keep their momentum and angular momentum", "[contact]") {
  const double phi = GENERATE(0.0, 40.0);
  System s(
      build({meshed("one", box_at({1, 0.8, 0.6}, {2, 2, 1}, rotation({1, 2, 3}, 0.4), {0, 0, 0})),
             meshed("other", box_at({0.7, 0.7, 0.7}, {1, 2, 2}, rotation({3, -1, 1}, 1.1), {1.4, 0.3, 0.1}))},
            {{"one", "other", friction(phi)}}));
  cdem::RunOptions options;
  options.steps = 1;
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i) {
    const bool other = block_of(s.model, i) == 1;
    s.state.velocity[i] =
        node(other ? Vec3(-6, 0.5, -1) + Vec3(0, 3, 5).cross(s.model.node_position[i]) : Vec3(2, 1, 0));
  }
  s.state.spent.external = s.state.spent.external_peak = cdem::kinetic_energy(s.model, s.state);
  const Momentum before = momentum(s, Places::present);
  std::size_t contacts = 0;
  options.steps = 40000;
  options.callback_every = 50;
  options.callback = [&] { contacts = std::max(contacts, s.state.contacts.size()); };
  s.run(options);
  REQUIRE(contacts > 0);
  REQUIRE(s.state.contacts.empty());
  const Momentum after = momentum(s, Places::present);
  CHECK((after.linear - before.linear).norm() < 1e-12 * before.linear.norm());
  CHECK((after.angular - before.angular).norm() < 1e-10 * before.angular.norm());
  const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
  const double kinetic = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
      sum += 0.5 * s.model.node_mass[i] * vec(s.state.velocity[i]).squaredNorm();
    return sum;
  }();
  CHECK(kinetic > 0);
  INFO("elastic " << ledger.elastic << " kinetic " << ledger.kinetic << " friction " << ledger.friction);
  CHECK(ledger.friction >= 0);
  if (phi == 0)
    CHECK(ledger.friction < 1e-3 * ledger.kinetic);
}

TEST_CASE("contact: the same bits for every number of threads, and however often contacts are looked for",
          "[contact]") {
  const auto hash_with = [](int threads, bool anew_every_200_steps) {
    std::vector<geom::TetMesh> units;
    for (int i = 0; i < 4; ++i)
      units.push_back(box_at({0.5, 0.4, 0.3}, {2, 2, 2}, rotation({1, 1.0 + i, 0.5}, 0.7 * i),
                             {0.2 * i, 0.1 * i, 0.5 + 0.7 * i}));
    cdem::Elastic soft = rock();
    soft.youngs_modulus = 3e8;
    soft.stiffness_damping = 2e-6;
    cdem::BodySpec bodies = meshed("units", units[0], {}, soft);
    bodies.meshes = units;
    System s(build(
        {meshed("floor", box_at({6, 6, 0.4}, {6, 6, 1}, Mat3::Identity(), {0, 0, -0.2}), {}, soft), bodies},
        {{"floor", "units", friction(35)}, {"units", "units", friction(35)}}));
    s.threads = threads;
    s.hold(body_of("floor"), "xyz");
    s.conditions.gravity = gravity();
    for (cdem::Node& v : s.state.velocity)
      v.z = -2;
    cdem::RunOptions options;
    options.steps = 4000;
    options.callback_every = 100;
    bool touched = false;
    options.callback = [&] { touched = touched || !s.state.contacts.empty(); };
    std::optional<cdem::RestartPoint> restart_point; // where a stage can be left
    cdem::run({s.model, s.state, s.conditions, s.log, s.last_good, s.observer, s.threads, 1, nullptr,
               anew_every_200_steps ? &restart_point : nullptr},
              options);
    CHECK(touched);
    CHECK(restart_point.has_value() == anew_every_200_steps);
    return cdem::hash(s.state);
  };
  const auto once = hash_with(1, false);
  CHECK(hash_with(2, false) == once);
  CHECK(hash_with(4, true) == once);
  CHECK(hash_with(1, true) == once);
}

TEST_CASE("contact: a body that was put elsewhere between two stages meets what stands there", "[contact]") {
  System s(build({meshed("plate", box_at({3, 3, 0.4}, {6, 6, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("block", box_at({1, 1, 1}, {2, 2, 2}, Mat3::Identity(), {0, 0, 1}))},
                 {{"plate", "block", friction(30)}}));
  cdem::RunOptions options;
  options.steps = 1;
  s.run(options);
  REQUIRE(s.state.contacts.empty());
  const double depth =
      0.04; // a fifth of a tet's height or less, far more than a search allows for between steps
  for (int i = s.model.blocks[1].node_begin; i < s.model.blocks[1].node_end; ++i)
    s.state.displacement[i].z -= 0.5 + depth;
  s.run(options);
  REQUIRE_FALSE(s.state.contacts.empty());
  double deepest = 0;
  for (const cdem::Contact& c : s.state.contacts) {
    deepest = std::max(deepest, c.depth);
    CHECK(c.effective_penetration() == 0); // it was found that deep
  }
  CHECK(deepest == Approx(depth));
}

TEST_CASE("contact: bodies without a law that meet end the run", "[contact][errors]") {
  System s(build({meshed("floor", box_at({2, 2, 0.4}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("unit", box_at({0.5, 0.5, 0.5}, {1, 1, 1}, Mat3::Identity(), {0, 0, 0.5}))}));
  s.hold(body_of("floor"), "xyz");
  for (cdem::Node& v : s.state.velocity)
    v.z = -3;
  cdem::RunOptions options;
  options.duration = 0.5;
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("\"floor\" and \"unit\" meet") &&
                                        Catch::Contains("{\"floor\", \"unit\", cdem.coulomb{"));
}

TEST_CASE("contact: bodies that stand in each other are refused", "[contact][errors]") {
  const auto model_with = [](const Vec3& place, double size) {
    return build({meshed("floor", box_at({2, 2, 0.4}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("unit", box_at({size, size, size}, {1, 1, 1}, Mat3::Identity(), place))},
                 {{"floor", "unit", friction(30)}});
  };
  CHECK_NOTHROW(model_with({0, 0, 0.25}, 0.5)); // it stands on it
  CHECK_THROWS_WITH(model_with({0, 0, 0.2}, 0.5),
                    Catch::Contains("\"floor\" and \"unit\" stand in each other"));
  CHECK_THROWS_WITH(model_with({0.1, 0.1, -0.2}, 0.1),
                    Catch::Contains("\"floor\" and \"unit\" stand in each other")); // swallowed
}

TEST_CASE("contact: a contact that gets too deep ends the run", "[contact][errors]") {
  cdem::Joint soft = friction(30);
  soft.normal_stiffness = 1e6;
  System s(build({meshed("floor", box_at({2, 2, 0.4}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("unit", box_at({0.5, 0.5, 0.5}, {1, 1, 1}, Mat3::Identity(), {0, 0, 0.3}))},
                 {{"floor", "unit", soft}}));
  s.hold(body_of("floor"), "xyz");
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 1)
      s.state.velocity[i] = node({0, 0, -20});
  cdem::RunOptions options;
  options.duration = 0.1;
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("too deep into"));
}

TEST_CASE("contact: a place that is not a number ends the run with its name", "[contact][errors]") {
  System s(build({meshed("floor", box_at({2, 2, 0.4}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("unit", box_at({0.5, 0.5, 0.5}, {1, 1, 1}, Mat3::Identity(), {0, 0, 0.26}))},
                 {{"floor", "unit", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  cdem::RunOptions options;
  options.steps = 6000;
  options.callback_every = 3000;
  bool injected = false;
  options.callback = [&] {
    if (!injected)
      s.state.displacement.back().y = std::numeric_limits<double>::quiet_NaN();
    injected = true;
  };
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("not a number in block") && Catch::Contains("\"unit\""));
}

TEST_CASE("contact: two bodies that collide do so whichever comes first, however they are turned, whatever "
          "else there is",
          "[contact]") {
  enum Case { swapped, turned, beside_a_far_one };
  const auto collide = [](const std::set<Case>& how) {
    const Mat3 turn = rotation({0, 0, 1}, how.count(turned) ? 90 * degree : 0);
    std::vector<cdem::BodySpec> bodies{
        meshed("one", placed(box_at({1, 0.8, 0.6}, {2, 2, 1}, rotation({1, 2, 3}, 0.4), {0, 0, 0}), turn,
                             Vec3::Zero())),
        meshed("two", placed(box_at({0.7, 0.7, 0.7}, {1, 2, 2}, rotation({3, -1, 1}, 1.1), {1.25, 0.3, 0.1}),
                             turn, Vec3::Zero()))};
    int two = 1;
    if (how.count(swapped)) {
      std::swap(bodies[0], bodies[1]);
      two = 0;
    }
    if (how.count(beside_a_far_one)) // of many small tetrahedra
      bodies.push_back(meshed("far", box_at({0.2, 0.2, 0.2}, {6, 6, 6}, Mat3::Identity(), {50, 0, 0})));
    System s(build(bodies, {{"one", "two", friction(0)}}));
    for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i) {
      const Vec3 x = turn.transpose() * s.model.node_position[i];
      const Vec3 v = block_of(s.model, i) == two ? Vec3(Vec3(-6, 0.5, -1) + Vec3(0, 3, 5).cross(x))
                     : block_of(s.model, i) == 2 ? Vec3(Vec3::Zero())
                                                 : Vec3(2, 1, 0);
      s.state.velocity[i] = node(turn * v);
    }
    cdem::RunOptions options;
    options.steps = 60000;
    options.time_step = 2e-6;
    bool edges = false;
    options.callback_every = 5;
    options.callback = [&] {
      for (const cdem::Contact& c : s.state.contacts)
        edges = edges || c.kind == cdem::Contact::edge;
    };
    s.run(options);
    REQUIRE(edges);
    REQUIRE(s.state.contacts.empty());
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
      if (block_of(s.model, i) == two)
        sum += s.model.node_mass[i] * vec(s.state.velocity[i]);
    return Vec3(turn.transpose() * sum);
  };
  const Vec3 once = collide({});
  CHECK((collide({swapped}) - once).norm() < 1e-9 * once.norm());
  CHECK((collide({turned}) - once).norm() < 1e-9 * once.norm());
  CHECK((collide({beside_a_far_one}) - once).norm() == 0);
}

TEST_CASE("contact: a block whose mesh may break slides on a plate as one that may not",
          "[contact][fracture]") {
  // Led along at a micron of depth, over edges of the plate's triangles, no friction. A place of its bottom and one of
  // its side count as one where bonds part edges; the depth stays that of the bottom.
  static constexpr double depth = 1e-6, speed = 0.1;
  const auto deepest_and_work = [](bool bonded) {
    cdem::Bonding bonding;
    bonding.everywhere = bonded;
    cdem::BodySpec block =
        meshed("block", box_at({0.3, 0.2, 0.2}, {3, 2, 2}, Mat3::Identity(), {0.31, 0.013, 0.1 + 1e-4}),
               bonding, rock());
    cdem::BodySpec plate =
        meshed("plate", box_at({1.2, 0.6, 0.2}, {12, 6, 2}, Mat3::Identity(), {0.5, 0, -0.1}), {});
    plate.element = block.element = cdem::Element::rigid;
    System s(build({plate, block}, {{"plate", "block", friction(0)}}));
    s.hold(body_of("plate"), "xyz");
    s.hold(body_of("block"), "xyz");
    cdem::RunOptions options;
    options.steps = 100;
    const double down = 1e-4 + depth;
    options.time_step = 1e-5;
    s.conditions.fixes.back().velocity = Vec3(0, 0, -down / (options.time_step * 100));
    s.run(options);
    s.conditions.fixes.back().velocity = Vec3(speed, 0, 0);
    const double before = s.state.spent.external;
    options.steps = 0;
    options.duration = 0.1 / speed;
    s.run(options);
    return std::pair(s.log.deepest_contact, std::abs(s.state.spent.external - before));
  };
  const auto [deepest, work] = deepest_and_work(true);
  CHECK(deepest < 1.5 * depth);
  const auto [deepest_of_one, work_of_one] = deepest_and_work(false);
  CHECK(deepest_of_one < 1.5 * depth);
  CHECK(work == Approx(work_of_one).margin(0.01));
}

namespace {

System rigid_cube_over_floor(double stiffness, double speed) {
  cdem::Elastic material = rock();
  material.youngs_modulus = stiffness;
  cdem::BodySpec floor =
      meshed("floor", box_at({3, 3, 1}, {4, 4, 2}, Mat3::Identity(), {0, 0, -0.5}), {}, material);
  cdem::BodySpec cube =
      meshed("cube", box_at({1, 1, 1}, {3, 3, 3}, Mat3::Identity(), {0, 0, 0.6}), {}, material);
  floor.element = cube.element = cdem::Element::rigid;
  System s(build({floor, cube}, {{"floor", "cube", friction(0)}}));
  s.hold(body_of("floor"), "xyz");
  s.state.rigid[1].velocity = {0, 0, -speed};
  return s;
}

} // namespace

TEST_CASE("contact: a rigid cube that hits a floor flat gives back its energy at the default step",
          "[contact][rigid]") {
  for (const double speed : {1.137, 1.274, 1.411, 1.548, 1.685, 1.822}) {
    System s = rigid_cube_over_floor(30e9, speed);
    const double before = cdem::kinetic_energy(s.model, s.state);
    cdem::RunOptions options;
    options.duration = 0.3 / speed;
    s.run(options);
    CHECK(s.state.rigid[1].velocity[2] > 0);
    CHECK(cdem::kinetic_energy(s.model, s.state) / before == Approx(1).margin(0.12));
  }
}

TEST_CASE("contact: a step too long for rigid bodies that touch is refused", "[contact][rigid][input]") {
  System s = rigid_cube_over_floor(30e9, 1);
  cdem::RunOptions options;
  options.steps = 10;
  options.time_step = 1e-3;
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("time_step = 0.001: must be at most ") &&
                                        Catch::Contains("rigid bodies that touch"));
}

TEST_CASE("contact: a fast, soft rigid cube does not pass through a floor unseen", "[contact][rigid]") {
  System s = rigid_cube_over_floor(1e6, 20);
  cdem::RunOptions options;
  options.duration = 0.12;
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("\"cube\" has gone too deep into \"floor\"") ||
                                        Catch::Contains("\"floor\" has gone too deep into \"cube\""));
}

TEST_CASE("a velocity that nodes are held at is work of what holds them", "[energy]") {
  System s(build({meshed("cube", box_at({1, 1, 1}, {2, 2, 2}, Mat3::Identity(), {0, 0, 0}), {})}));
  s.hold(body_of("cube"), "xyz");
  s.conditions.fixes.back().velocity = Vec3(0.5, 0, 0);
  cdem::RunOptions options;
  options.steps = 10;
  s.run(options);
  CHECK(s.state.spent.external == Approx(0.5 * rock().density * 0.25).epsilon(1e-6));
  CHECK(cdem::energy(s.model, s.state).total() == Approx(s.state.spent.external).epsilon(1e-6));
}

TEST_CASE("contact: the thickness of a law between meshes gives its stiffness", "[contact]") {
  // E / L and G / L of both bodies in series, as between blocks.
  cdem::Joint thin = friction(30), stiff = friction(30);
  thin.thickness = 0.01;
  stiff.normal_stiffness = rock().youngs_modulus / 0.01;
  stiff.shear_stiffness = rock().shear_modulus() / 0.01;
  const auto of = [](const cdem::Joint& joint) {
    return build({meshed("a", geom::box_mesh({1, 1, 1}, {1, 1, 1})),
                  meshed("b", box_at({1, 1, 1}, {1, 1, 1}, Mat3::Identity(), {0.5, 0.5, 2.5}))},
                 {{"a", "b", joint}});
  };
  const auto law = [](const cdem::Model& m) { return m.joints[m.surface.joint.at({0, 1})]; };
  CHECK(*law(of(thin)).normal_stiffness == Approx(*law(of(stiff)).normal_stiffness));
  CHECK(*law(of(thin)).shear_stiffness == Approx(*law(of(stiff)).shear_stiffness));
}

TEST_CASE("contact: what a law between meshes or blocks of small strain would ignore is refused",
          "[contact]") {
  const auto refused = [](const std::vector<cdem::BodySpec>& bodies, const cdem::Joint& law) {
    return refusal([&] { (void)build(bodies, {{"a", "b", law}}); });
  };
  const std::vector<cdem::BodySpec> meshes{
      meshed("a", geom::box_mesh({1, 1, 1}, {1, 1, 1})),
      meshed("b", box_at({1, 1, 1}, {1, 1, 1}, Mat3::Identity(), {0.5, 0.5, 2.5}))};
  cdem::Joint damped = friction(30);
  damped.stiffness_damping = 1e-5;
  CHECK_THAT(refused(meshes, damped), Catch::Matchers::Contains("stiffness_damping") &&
                                          Catch::Matchers::Contains("give the contact restitution"));
  cdem::Joint ratio = friction(30);
  ratio.thickness_ratio = 0.1;
  CHECK_THAT(refused(meshes, ratio), Catch::Matchers::Contains("give thickness (m)"));
  const std::vector<cdem::BodySpec> blocks{body("a", geom::grid({1, 1, 1}, {1, 1, 1})),
                                           body("b", geom::grid({1, 1, 1}, {1, 1, 1}, {0, 0, 1}))};
  CHECK_THAT(refused(blocks, damped), Catch::Matchers::Contains("between bodies of small strain"));
  // Blocks that move far and touch have damped springs between them; what meets later has contact alone.
  std::vector<cdem::BodySpec> touch = blocks, apart = blocks;
  for (std::vector<cdem::BodySpec>* bodies : {&touch, &apart})
    for (cdem::BodySpec& one : *bodies)
      one.element = cdem::Element::finite_volume;
  for (Vec3& x : apart[1].shape.blocks[0].vertices)
    x.z() += 0.5;
  CHECK(refused(touch, damped).empty());
  CHECK_THAT(refused(apart, damped),
             Catch::Matchers::Contains("contacts {\"a\", \"b\"}: stiffness_damping") &&
                 Catch::Matchers::Contains("do not touch when the model is built"));
  cdem::Joint own = rock_joint();
  own.stiffness_damping = 1e-5;
  CHECK_THAT(refusal([&] {
               (void)build({body("a", geom::grid({1, 1, 1}, {2, 1, 1}), rock(), own)});
             }),
             Catch::Matchers::Contains("joint of body \"a\".stiffness_damping"));
}
