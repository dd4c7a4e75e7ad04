// Initial velocity and spin: every body starts with the motion of a rigid body, and in free flight keeps its energy and
// its momenta, be it of blocks, a mesh or rigid.
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/procedure/give_motion.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

enum class Kind { blocks, zoned, mesh, bonded_mesh, rigid_blocks, rigid_mesh };

cdem::BodySpec body_of_kind(Kind kind, const Vec3& at) {
  const bool mesh = kind == Kind::mesh || kind == Kind::bonded_mesh || kind == Kind::rigid_mesh;
  cdem::Joint strong = rock_joint();
  strong.cohesion = strong.tensile_strength = 1e12;
  cdem::Bonding bonding;
  bonding.everywhere = kind == Kind::bonded_mesh;
  geom::VoronoiOptions cells;
  cells.size = {1, 0.8, 1.2};
  cells.count = kind == Kind::rigid_blocks ? 1 : 6;
  cells.origin = at;
  cdem::BodySpec spec =
      mesh
          ? meshed("body", placed(geom::box_mesh({1, 0.8, 1.2}, {2, 2, 3}, 0.15), geom::Mat3::Identity(), at),
                   bonding, rock(), strong)
          : body("body", geom::voronoi(cells), rock(), strong);
  spec.element = kind == Kind::rigid_blocks || kind == Kind::rigid_mesh ? cdem::Element::rigid
                                                                        : cdem::Element::finite_volume;
  if (kind == Kind::zoned)
    spec.zone_size = 0.4;
  return spec;
}

std::vector<int> all_nodes(const System& s) {
  std::vector<int> nodes(s.model.node_position.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = static_cast<int>(i);
  return nodes;
}

// Of bodies that are rigid or not, about the origin.
Momentum momentum_of(const System& s) {
  if (s.model.rigid.empty())
    return momentum(s, Places::present);
  Momentum sum;
  for (std::size_t r = 0; r < s.model.rigid.size(); ++r) {
    const cdem::RigidState& motion = s.state.rigid[r];
    const Vec3 p = s.model.rigid[r].mass * cdem::vec(motion.velocity);
    sum.linear += p;
    sum.angular += cdem::vec(motion.angular_momentum) + cdem::vec(motion.centroid).cross(p);
  }
  return sum;
}

} // namespace

TEST_CASE("a body that is given spin and velocity flies on with its energy and momenta", "[initial_motion]") {
  const Kind kind = GENERATE(Kind::blocks, Kind::zoned, Kind::mesh, Kind::bonded_mesh, Kind::rigid_blocks,
                             Kind::rigid_mesh);
  INFO("kind " << static_cast<int>(kind));
  const Vec3 at(5, -3, 2), velocity(1, -2, 0.5), w = 20 * Vec3(1, 2, -0.5).normalized(); // rad/s, skew axis
  System s(build({body_of_kind(kind, at)}));
  const std::vector<int> nodes = all_nodes(s);
  const Vec3 centre = cdem::centroid_of(s.model, s.state, nodes);
  CHECK((centre - (at + Vec3(0.5, 0.4, 0.6))).norm() < 1e-9);
  const double given = cdem::give_motion(s.model, s.state, nodes, {velocity, w, centre}, "all");

  // p = m v, L = I w about the centroid: I of the masses at the nodes, of a rigid body that of the solid.
  double mass = 0;
  geom::Mat3 inertia = geom::Mat3::Zero();
  for (const int i : nodes) {
    const Vec3 r = s.model.node_position[i] - centre;
    mass += s.model.node_mass[i];
    inertia += s.model.node_mass[i] * (r.squaredNorm() * geom::Mat3::Identity() - r * r.transpose());
  }
  const bool rigid = kind == Kind::rigid_blocks || kind == Kind::rigid_mesh;
  if (rigid) { // a box of 1 x 0.8 x 1.2 m, in one piece or in blocks that turn about one centroid
    inertia.setZero();
    for (std::size_t r = 0; r < s.model.rigid.size(); ++r) {
      const Vec3 arm = cdem::vec(s.state.rigid[r].centroid) - centre;
      inertia += s.model.rigid[r].inertia +
                 s.model.rigid[r].mass * (arm.squaredNorm() * geom::Mat3::Identity() - arm * arm.transpose());
    }
    const Vec3 of_box = mass / 12 * Vec3(0.64 + 1.44, 1 + 1.44, 1 + 0.64);
    if (s.model.rigid.size() == 1)
      CHECK((inertia - geom::Mat3(of_box.asDiagonal())).norm() < 1e-9 * of_box.norm());
  }
  const Vec3 spin = inertia * w;
  CHECK(given == Approx(0.5 * mass * velocity.squaredNorm() + 0.5 * w.dot(spin)));
  CHECK(cdem::energy(s.model, s.state).kinetic == Approx(given));
  const Momentum before = momentum_of(s);
  CHECK((before.linear - mass * velocity).norm() < 1e-9 * mass);
  CHECK((before.angular - centre.cross(mass * velocity) - spin).norm() < 1e-9 * before.angular.norm());

  const double turn = 2 * pi / w.norm();
  cdem::RunOptions options;
  options.duration = 3 * turn;
  if (!s.model.rigid.empty())
    options.time_step = turn / 1000;
  s.run(options);
  const cdem::EnergyLedger now = cdem::energy(s.model, s.state);
  CHECK(now.total() == Approx(given).epsilon(1e-3));
  const Momentum after = momentum_of(s);
  CHECK((after.linear - before.linear).norm() < 1e-9 * before.linear.norm());
  // Springs of interfaces keep it to the order of slip times force only (theory, section 20).
  const double kept = s.model.interfaces.empty() ? 1e-9 : 1e-6;
  CHECK((after.angular - before.angular).norm() < kept * before.angular.norm());
}

TEST_CASE("spin about a point is a velocity w x (x - about), of each place that it is given to",
          "[initial_motion]") {
  cdem::ModelSpec spec;
  spec.bodies = {body("left", geom::grid({1, 1, 1}, {1, 1, 1}, {0, 0, 0})),
                 body("right", geom::grid({1, 1, 1}, {1, 1, 1}, {3, 0, 0}))};
  spec.bodies[1].element = cdem::Element::rigid;
  cdem::Simulation s(spec, 1, nullptr);
  const Vec3 about(0, 0, 5), w(0, 0.3, 0);
  s.initial_velocity(cdem::Selection::everything(), Vec3::Zero(), w, about);
  for (const cdem::Simulation::BlockRow& row : s.blocks()) {
    const Vec3 expected = w.cross(row.centroid - about);
    const auto on = cdem::Selection::of_body(row.body);
    CHECK(s.mean("velocity.x", on) == Approx(expected.x()));
    CHECK(s.mean("velocity.z", on) == Approx(expected.z()));
  }
  // Anew, each about its own centroid: nothing is left of the motion before.
  for (const char* name : {"left", "right"})
    s.initial_velocity(body_of(name), Vec3::Zero(), w);
  for (const char* name : {"left", "right"}) {
    CHECK(std::abs(s.mean("velocity.x", body_of(name))) < 1e-12);
    CHECK(s.max("velocity.x", body_of(name)).value == Approx(0.15));
  }
  const cdem::EnergyLedger ledger = s.energy();
  CHECK(ledger.external == Approx(ledger.kinetic)); // what is given and taken is booked
}

TEST_CASE("spin of bodies that have moved and turned is about where they are now", "[initial_motion]") {
  const bool rigid = GENERATE(false, true);
  const double rate = 5;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("unit", box_at({1, 0.5, 0.3}, {2, 1, 1}, geom::Mat3::Identity(), {0, 0, 0}))};
  if (rigid)
    spec.bodies[0].element = cdem::Element::rigid;
  cdem::Simulation s(spec, 1, nullptr);
  s.initial_velocity(cdem::Selection::everything(), {2, 0, 0}, {0, 0, rate});
  cdem::RunOptions options;
  options.duration = 0.5 * pi / rate; // a quarter turn
  if (rigid)
    options.time_step = options.duration / 400;
  s.run(options);
  const double before = s.energy().kinetic;
  s.initial_velocity(cdem::Selection::everything(), {0, 0, 0}, {rate, 0, 0});
  // About x, which is now the unit's own -y: half the sum of the squares of its other two sides.
  const cdem::EnergyLedger now = s.energy();
  CHECK(now.kinetic < before);
  CHECK(std::abs(now.balance_error()) < 1e-3);
  CHECK(std::abs(s.mean("velocity.y", cdem::Selection::everything())) < 1e-3);
  const double length = 1, depth = 0.3, mass = rock().density * 1 * 0.5 * 0.3;
  const double about_own_y = mass * (length * length + depth * depth) / 12;
  // The masses at the nodes of this mesh have a larger moment; that about the other axis would be 3.8 times smaller.
  const double expected = 0.5 * about_own_y * rate * rate;
  CHECK(now.kinetic > (1 - 1e-9) * expected);
  CHECK(now.kinetic < (rigid ? 1 + 1e-9 : 2.5) * expected);
}

TEST_CASE("a velocity given to what supports hold against it is refused", "[initial_motion]") {
  const bool rigid = GENERATE(false, true);
  cdem::ModelSpec spec;
  spec.bodies = {body("left", geom::grid({1, 1, 1}, {1, 1, 1}, {0, 0, 0})),
                 body("right", geom::grid({1, 1, 1}, {1, 1, 1}, {3, 0, 0}))};
  spec.bodies[0].element = rigid ? cdem::Element::rigid : cdem::Element::finite_volume;
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(body_of("left")));
  s.fix(fixed(body_of("right"), "x"));
  const auto refusal = [&](const char* on, const Vec3& velocity) {
    try {
      s.initial_velocity(body_of(on), velocity, Vec3::Zero());
    } catch (const geom::InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK_THAT(refusal("left", {1, 0, 0}), Catch::Matchers::Contains("model:fix holds every node there"));
  CHECK_THAT(refusal("right", {1, 0, 0}), Catch::Matchers::Contains("model:fix holds every node there"));
  CHECK(refusal("right", {1, 0, 2}).empty()); // it may move along z
  CHECK(refusal("left", {0, 0, 0}).empty());
  CHECK_NOTHROW(s.initial_velocity(cdem::Selection::everything(), {0, 0, 1}, Vec3::Zero()));
}
