// The flow at which a lone cube leaves its place on a slope, by statics. It lies flat on a slope of angle a with friction
// mu; its weight less buoyancy is W' = (rho - rho_w) g h^3. A flow up the slope looks at one face and pushes with
// F = rho_w V^2 / 2 h^2 (Feng 2014 eqs 19-20) in the height of the centroid, where W' acts too. It slides up at
//
//     F = W' (sin a + mu cos a)
//
// and would tip over its upper edge at F = W' (sin a + cos a): it slides for mu < 1 and tips for mu > 1. At rest without a
// flow it needs mu > tan a.
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double g = 9.81, slope = 25 * degree, water_density = 1025;
// m/s2, of F over the mass of the cube when it goes.
double critical_acceleration(double mu) {
  return (1 - water_density / rock().density) * g * (std::sin(slope) + std::min(mu, 1.0) * std::cos(slope));
}
double critical_velocity(double size, double mu) {
  return std::sqrt(2 * rock().density * size * critical_acceleration(mu) / water_density);
}

geom::TetMesh box(const Vec3& size, const std::array<int, 3>& divisions, const Vec3& corner) {
  geom::TetMesh mesh = geom::box_mesh(size, divisions);
  for (Vec3& x : mesh.nodes)
    x += corner;
  return mesh;
}

// The slope lies level, up along x, and gravity leans. Time in units of sqrt(h / g).
struct Cube {
  double size, unit_of_time = std::sqrt(size / g);
  double velocity = 0; // of the flow now, m/s
  double rate = 0;     // m/s2, from `since` on
  double since = 0;    // s
  cdem::Simulation model;
  std::size_t watch = 0;
  bool stops = true; // a run, when it has left

  Cube(double h, double mu, cdem::Element element)
      : size(h), model([&] {
          cdem::Joint contact;
          contact.bonded = false;
          contact.friction_angle = std::atan(mu);
          // Without loss a rigid cube that slides comes to rock on its leading edge, from mu = 0.65 on: what friction
          // feeds into the rocking nothing takes out.
          if (element == cdem::Element::rigid && mu < 1)
            contact.restitution = 0.5;
          // It sinks in by a millionth of its height: the law is that of a rigid cube.
          contact.normal_stiffness = 1e6 * rock().density * g;
          cdem::ModelSpec spec;
          spec.bodies = {meshed("slope", box({4 * h, 3 * h, 0.5 * h}, {2, 2, 1}, {-h, -1.5 * h, -0.5 * h})),
                         meshed("cube", box({h, h, h}, {2, 2, 2}, {0, -0.5 * h, 0}))};
          spec.bodies[0].element = cdem::Element::rigid;
          spec.bodies[1].element = element;
          if (element != cdem::Element::rigid) // else what rings in it makes it slip a per cent too early
            spec.bodies[1].material.stiffness_damping = 1e-5;
          spec.pairs = {{"slope", "cube", contact}};
          return cdem::Simulation(spec, 1, nullptr);
        }()) {
    cdem::Fix fix;
    fix.on = cdem::Selection::of_body("slope");
    model.fix(fix);
    cdem::Gravity gravity;
    gravity.acceleration = g * Vec3(-std::sin(slope), 0, -std::cos(slope));
    gravity.water_density = water_density;
    model.gravity(gravity);
    cdem::Flow flow;
    flow.on = {cdem::Selection::of_body("cube")};
    flow.direction = {1, 0, 0};
    flow.water_density = water_density;
    flow.relative = false; // the statics are those of a cube at rest
    flow.velocity = [this](double time) { return velocity + rate * std::max(0.0, time - since); };
    model.flow(flow);
  }
  Cube(const Cube&) = delete;
  Cube& operator=(const Cube&) = delete;

  // Lies still under the flow of now, watched from then on.
  void settle() {
    run(4, 0.5);
    watch = model.watch("cube", 1e-3 * size);
  }
  void run(double duration, double local_damping = 0) {
    cdem::RunOptions options;
    options.duration = duration * unit_of_time;
    options.local_damping = local_damping;
    options.stop = [&] { return local_damping == 0 && stops && !model.log().watches.at(watch).left.empty(); };
    model.run(options);
  }
};

} // namespace

TEST_CASE("a flow that rises slowly takes a lone cube at F = W' (sin a + mu cos a), or tips it",
          "[flow][watch]") {
  const auto [element, size] =
      GENERATE(std::pair(cdem::Element::rigid, 1.5), std::pair(cdem::Element::rigid, 0.1),
               std::pair(cdem::Element::finite_volume, 1.5));
  const double mu = GENERATE(0.55, 0.75, 1.5), critical = critical_velocity(size, mu);
  Cube cube(size, mu, element);
  cube.velocity = 0.95 * critical;
  cube.settle();
  cube.since = cube.model.time();
  cube.rate = 0.005 * critical / cube.unit_of_time;
  cube.run(20);
  CAPTURE(mu, size, critical, cube.model.steps());
  REQUIRE(cube.model.log().watches.at(cube.watch).left.size() == 1);
  const cdem::Departure& left = cube.model.log().watches.at(cube.watch).left[0];
  // While it goes its first 1e-3 h the flow rises by half a per cent: (3 x 1e-3 x 0.005^2 / (F / m g))^(1/3).
  CHECK(left.velocity == Approx(critical).epsilon(0.01));
  const double rises = left.displacement.z() / left.displacement.x(); // 1 where it turns about its upper edge
  if (mu < 1)
    CHECK(std::abs(rises) < (element == cdem::Element::rigid ? 0.01 : 0.1)); // one that deforms chatters
  else
    CHECK(rises == Approx(1).epsilon(0.1));
}

TEST_CASE("a lone cube stays under a flow held below the critical one, and slides under one above it with "
          "the surplus",
          "[flow][watch]") {
  const double mu = GENERATE(0.55, 0.8), size = GENERATE(1.5, 0.1), critical = critical_velocity(size, mu);
  Cube cube(size, mu, cdem::Element::rigid);
  cube.velocity = 0.98 * critical; // settled there: a jump would swing it past
  cube.settle();
  cube.run(10);
  CAPTURE(mu, size);
  CHECK(cube.model.log().watches.at(cube.watch).left.empty());
  cube.velocity = 1.1 * critical;
  cube.stops = false;
  const double before = cube.model.mean("displacement.x", cdem::Selection::of_body("cube"));
  cube.run(1);
  const double way = cube.model.mean("displacement.x", cdem::Selection::of_body("cube")) - before;
  const double expected =
      0.5 * (1.1 * 1.1 - 1) * critical_acceleration(mu) * cube.unit_of_time * cube.unit_of_time;
  CHECK(way == Approx(expected).epsilon(0.02));
}
