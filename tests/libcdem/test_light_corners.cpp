// Short edges do not set the time step of blocks that move far: a cube without a tiny corner beside the whole cube.
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/model/build/convex_inertia.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "tests/libcdem/boxes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

// A unit cube less the corner that a skew plane cuts off at the distance `corner` (m) along the edges; 0: the whole cube.
geom::Polyhedron cube_without(double corner) {
  const geom::Polyhedron cube = geom::make_box({0, 0, 0}, {1, 1, 1});
  if (corner == 0)
    return cube;
  return geom::cut(cube, geom::Plane::through({1 - corner, 1, 1}, Vec3(1, 1.3, 0.8))).below->shape;
}

System system_of(std::vector<geom::Polyhedron> blocks) {
  cdem::BodySpec spec = body("block", {});
  spec.shape.blocks = std::move(blocks);
  spec.element = cdem::Element::finite_volume;
  return System(build({spec}));
}

double least_step(const cdem::Model& model, const std::vector<double>& masses) { // s; masses: kg (n_nodes)
  const std::vector<double> sums = cdem::all_row_sums(model);
  double least = 1;
  for (std::size_t i = 0; i < sums.size(); ++i)
    least = std::min(least, cdem::stable_time_step(sums[i] / masses[i], 0));
  return least;
}

} // namespace

TEST_CASE("a tiny corner that is cut off a block costs little of its time step, and no mass", "[moving]") {
  const System whole = system_of({cube_without(0)});
  const auto [corner, gain] = GENERATE(table<double, double>({{0.03, 3.0}, {0.003, 30.0}, {0.0003, 100.0}}));
  const System s = system_of({cube_without(corner)});
  REQUIRE(s.model.node_mass.size() > whole.model.node_mass.size());
  CAPTURE(corner);
  CHECK(least_step(s.model, s.model.node_mass) > gain * least_step(s.model, s.model.gravitational_mass));
  double mass = 0, weight = 0;
  for (std::size_t i = 0; i < s.model.node_mass.size(); ++i) {
    mass += s.model.node_mass[i];
    weight += s.model.gravitational_mass[i];
    CHECK(s.model.node_mass[i] > 0);
  }
  CHECK(mass == Approx(rock().density * s.model.blocks[0].mass.volume).epsilon(1e-12));
  CHECK(weight == Approx(mass).epsilon(1e-12));
}

TEST_CASE("a block with heavier corners vibrates as before", "[moving]") {
  const auto stored = [](bool raised) { // J, every 1e-5 s
    System s = system_of({cube_without(0.003)});
    if (!raised) {
      s.model.node_mass = s.model.gravitational_mass;
      cdem::match_convex_inertia(s.model, 0);
    }
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i) // it stretches along x
      s.state.velocity[i] = cdem::node({0.1 * (s.model.node_position[i].x() - 0.5), 0, 0});
    std::vector<double> energy;
    cdem::RunOptions options;
    options.duration = 1e-5;
    options.time_step = 1e-7;
    while (energy.size() < 40) {
      s.run(options);
      energy.push_back(cdem::mesh_elastic_energy(s.model, s.state));
    }
    return energy;
  };
  const std::vector<double> heavier = stored(true), before = stored(false);
  const double most = *std::max_element(before.begin(), before.end());
  for (std::size_t i = 0; i < before.size(); ++i)
    CHECK(std::abs(heavier[i] - before[i]) < 0.02 * most);
}
