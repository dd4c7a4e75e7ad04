// The pressure of a flow on what faces it, and the search for the flow that breaks a held body.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include "libcdem/load/flow.hpp"
#include "libcdem/results/energy.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double speed = 10, density = 1025;

cdem::Flow flow_along(const Vec3& direction, const cdem::Selection& on = {}) {
  cdem::Flow flow;
  flow.on = {on};
  flow.direction = direction;
  flow.velocity = [](double) { return speed; };
  return flow;
}

// A box sheared to a parallelepiped with these edges.
const geom::Mat3& edges() {
  static const geom::Mat3 columns = symmetric(1, 0.8, 1.3, 0.2, -0.1, 0.3);
  return columns;
}

geom::TetMesh parallelepiped() {
  geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {2, 3, 2}, 0.15);
  for (Vec3& x : mesh.nodes)
    x = edges() * x;
  return mesh;
}

// Of a parallelepiped seen along d: |d . a x b| + |d . b x c| + |d . c x a|.
double silhouette(const geom::Mat3& e, const Vec3& d) {
  const Vec3 a = e.col(0), b = e.col(1), c = e.col(2);
  return std::abs(d.dot(a.cross(b))) + std::abs(d.dot(b.cross(c))) + std::abs(d.dot(c.cross(a)));
}

Vec3 resultant(const cdem::ResolvedConditions& r) {
  Vec3 sum = Vec3::Zero();
  for (const cdem::Node& f : r.external)
    sum += vec(f);
  return sum;
}

void turn(System& s, const geom::Mat3& rotation) {
  for (std::size_t i = 0; i < s.state.displacement.size(); ++i) {
    const Vec3& x = s.model.node_position[i];
    s.state.displacement[i] = node(rotation * x - x);
  }
}

} // namespace

TEST_CASE("a flow pushes blocks by their faces as they have turned, zoned or not", "[flow]") {
  cdem::BodySpec spec = body("block", geom::grid({1, 0.8, 1.3}, {1, 1, 1}));
  spec.element = cdem::Element::finite_volume;
  spec.zone_size = GENERATE(0.0, 0.4);
  System s(build({spec}));
  const Vec3 d = Vec3(1, 2, -0.5).normalized();
  s.conditions.flows = {flow_along(d)};
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  const geom::Mat3 edges = Vec3(1, 0.8, 1.3).asDiagonal(), turned = rotation({1, 1, -2}, 130 * degree);
  const double pressure = 0.5 * density * speed * speed;
  for (const geom::Mat3& attitude : {geom::Mat3(geom::Mat3::Identity()), turned}) {
    turn(s, attitude);
    cdem::refresh_flows(s.model, s.state, r);
    cdem::update_external(r, 0);
    const Vec3 expected = pressure * silhouette(attitude * edges, d) * d;
    CHECK((resultant(r) - expected).norm() < 1e-10 * expected.norm());
  }
}

TEST_CASE("pressure and velocity of a flow turn into each other by F = rho V^2 / 2", "[flow]") {
  CHECK(cdem::flow_pressure(10, 1000) == Approx(50000).epsilon(1e-15));
  CHECK(cdem::flow_velocity(50000, 1000) == Approx(10).epsilon(1e-15));
  for (const double v : {0.0, 0.3, 20.8, 24.5})
    CHECK(cdem::flow_velocity(cdem::flow_pressure(v, 1025), 1025) == Approx(v).epsilon(1e-14));
}

TEST_CASE("a flow pushes a convex body with its pressure times the silhouette, along the flow", "[flow]") {
  const Vec3 d = GENERATE(Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(1, 2, -0.5), Vec3(-3, 0.1, 0.7));
  System s(build({meshed("unit", parallelepiped())}));
  s.conditions.flows = {flow_along(3 * d)};
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, 0);
  const Vec3 unit = d.normalized();
  const double pressure = 0.5 * density * speed * speed;
  const Vec3 expected = pressure * silhouette(edges(), unit) * unit;
  CHECK((resultant(r) - expected).norm() < 1e-10 * expected.norm());

  // The body turned, the same conditions: the faces that look at the flow now carry it, and no others.
  const geom::Mat3 rotated = rotation({1, 1, -2}, 130 * degree);
  turn(s, rotated);
  cdem::refresh_flows(s.model, s.state, r);
  cdem::update_external(r, 0);
  const Vec3 after = pressure * silhouette(rotated * edges(), unit) * unit;
  CHECK((resultant(r) - after).norm() < 1e-10 * after.norm());
}

TEST_CASE("an oblique flow on one face: A F cos(angle), along the flow", "[flow]") {
  const double angle = GENERATE(0.0, 30.0, 80.0);
  const Vec3 d(std::sin(angle * degree), 0, -std::cos(angle * degree));
  System s(build({meshed("unit", geom::box_mesh({2, 3, 1}, {2, 2, 2}))}));
  s.conditions.flows = {flow_along(d, cdem::Selection::side("z+"))};
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, 0);
  const Vec3 expected = 6 * 0.5 * density * speed * speed * std::cos(angle * degree) * d;
  CHECK((resultant(r) - expected).norm() < 1e-10 * expected.norm());
}

TEST_CASE("faces of a crack that has opened take the flow only when asked", "[flow]") {
  const bool new_faces = GENERATE(false, true);
  geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {2, 2, 2});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0;
    for (const int node : mesh.tets[t])
      z += mesh.nodes[node].z() / 4;
    mesh.region[t] = z > 0.5;
  }
  cdem::Bonding bonding;
  bonding.between_regions = true;
  System s(build({meshed("unit", mesh, bonding)}));
  cdem::Flow flow = flow_along({0, 0, -1});
  flow.new_faces = new_faces;
  s.conditions.flows = {flow};
  const double whole = 0.5 * density * speed * speed;
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, 0);
  CHECK((resultant(r) - Vec3(0, 0, -whole)).norm() < 1e-10 * whole);
  each_face_spring(s.model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace& at) {
    s.state.faces[at.batch].mode[at.point][at.lane] =
        static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
  });
  for (const double opening : {0.0, 0.02}) { // m
    for (std::size_t t = 0; t < s.model.tets.size(); ++t)
      for (const int node : s.model.tets[t])
        s.state.displacement[node].z = s.model.mesh.region[t] * opening;
    cdem::refresh_flows(s.model, s.state, r);
    cdem::update_external(r, 0);
    const int faces = new_faces && opening > 0 ? 2 : 1;
    CHECK((resultant(r) - Vec3(0, 0, -faces * whole)).norm() < 1e-10 * whole);
  }
}

TEST_CASE("a flow in a run follows the body that it turns", "[flow]") {
  // A free rod in a spin, fast beside the flow: after a quarter turn its broad side looks at the flow. The paper's law.
  System s(build({meshed("rod", geom::box_mesh({0.2, 0.2, 1}, {1, 1, 3}))}));
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node(Vec3(0, 60, 0).cross(s.model.node_position[i] - Vec3(0.1, 0.1, 0.5)));
  s.conditions.flows = {flow_along({0, 0, -1})};
  s.conditions.flows[0].relative = false;
  cdem::RunOptions options;
  options.duration = 0.5 * pi / 60;
  s.run(options);
  // Momentum gained: the integral of F A(angle), A = 0.04 |cos| + 0.2 |sin|.
  double gained = 0;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    gained += s.model.node_mass[i] * s.state.velocity[i].z;
  const double pressure = 0.5 * density * speed * speed;
  CHECK(gained == Approx(-pressure * 0.24 / 60).epsilon(0.01));
}

namespace {

// A cube of 1 m, its face to a flow along x.
System cube_in_flow(bool rigid) {
  cdem::BodySpec spec = meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}));
  if (rigid)
    spec.element = cdem::Element::rigid;
  System s(build({spec}));
  s.conditions.flows = {flow_along({1, 0, 0})};
  return s;
}

double mean_x_velocity(const System& s) {
  double gained = 0, mass = 0;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
    gained += s.model.node_mass[i] * s.state.velocity[i].x;
    mass += s.model.node_mass[i];
  }
  return gained / mass;
}

} // namespace

TEST_CASE("a flow that carries a free unit approaches its velocity and never passes it", "[flow]") {
  // m dv/dt = rho A (V - v)^2 / 2:  v = V - V / (1 + k V t), k = rho A / 2 m.
  const bool rigid = GENERATE(false, true);
  CAPTURE(rigid);
  System s = cube_in_flow(rigid);
  const double k = density / (2 * rock().density);
  double most = 0, worst = 0;
  cdem::RunOptions options;
  options.time_step = rigid ? 1e-3 : 0;
  options.duration = rigid ? 15 : 0.5; // the rigid one to 0.97 V
  options.callback_every = 10;
  options.callback = [&] {
    const double t = s.state.time - s.state.velocity_lag, v = mean_x_velocity(s);
    most = std::max(most, v);
    worst = std::max(worst, std::abs(v - (speed - speed / (1 + k * speed * t))));
  };
  s.run(options);
  CHECK(most < speed);
  CHECK(most > (rigid ? 0.96 : 0.4) * speed);
  CHECK(worst < (rigid ? 2e-3 : 5e-3) * speed);
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-3);
}

TEST_CASE("a flow that is not relative pushes a unit on past its velocity, and still water slows one down",
          "[flow]") {
  System s = cube_in_flow(true);
  cdem::RunOptions options;
  options.time_step = 1e-3;
  options.duration = 1;
  SECTION("v = k V^2 t") {
    s.conditions.flows[0].relative = false;
    options.duration = 2 / (density / (2 * rock().density) * speed);
    s.run(options);
    CHECK(mean_x_velocity(s) == Approx(2 * speed).epsilon(0.01));
  }
  SECTION("v = v0 / (1 + k v0 t), on the face that leads") {
    s.conditions.flows[0].velocity = [](double) { return 0.0; };
    for (cdem::Node& v : s.state.velocity)
      v.x = speed;
    s.state.rigid[0].velocity[0] = speed;
    s.run(options);
    const double k = density / (2 * rock().density);
    CHECK(mean_x_velocity(s) == Approx(speed / (1 + k * speed)).epsilon(2e-3));
  }
}
