// Bodies on walls made of open surfaces (geom::shell_mesh).
#include "libcdem/results/units.hpp"
#include "tests/libcdem/boxes.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/shell_mesh.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double earth_pull = 9.81; // m/s2

cdem::Simulation on_wall(geom::TetMesh wall, geom::Assembly blocks, cdem::Element element) {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("wall", std::move(wall)), body("blocks", std::move(blocks))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].element = element;
  spec.bodies[1].material.youngs_modulus = 1e9;
  spec.default_contact = friction(30);
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(body_of("wall")));
  return s;
}

cdem::RunOptions over_time(double time) {
  cdem::RunOptions options;
  options.duration = time;
  return options;
}

} // namespace

TEST_CASE("a block slides on a wall of an open surface with g (sin a - tan phi cos a)", "[contact]") {
  const geom::Surface sheet{{{-2, -1, 0}, {8, -1, 0}, {8, 2, 0}, {-2, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const double a = 40 * degree;
  cdem::Simulation s = on_wall(geom::shell_mesh(sheet, 0.2, {}), geom::grid({0.5, 0.5, 0.2}, {1, 1, 1}),
                               GENERATE(cdem::Element::rigid, cdem::Element::finite_volume));
  s.gravity(gravity({earth_pull * std::sin(a), 0, -earth_pull * std::cos(a)}));
  s.run(over_time(0.2));
  const double before = s.mean("velocity.x", body_of("blocks")), time = s.time();
  s.run(over_time(0.5));
  const double exact = earth_pull * (std::sin(a) - std::tan(30 * degree) * std::cos(a));
  CHECK((s.mean("velocity.x", body_of("blocks")) - before) / (s.time() - time) ==
        Approx(exact).epsilon(0.02));
  CHECK(std::abs(s.mean("displacement.z", body_of("blocks"))) < 1e-3);
}

TEST_CASE("blocks that fall into a drum from an open surface stay in it, and what they weigh is on it",
          "[contact]") {
  const int n = 24;
  const double r = 1;
  geom::Surface drum; // the lower half, along y
  for (int i = 0; i <= n; ++i)
    for (const double y : {-1., 1.})
      drum.points.emplace_back(-r * std::cos(M_PI * i / n), y, -r * std::sin(M_PI * i / n));
  for (int i = 0; i < 2 * n; i += 2) {
    drum.triangles.push_back({i, i + 1, i + 3});
    drum.triangles.push_back({i, i + 3, i + 2});
  }
  const geom::Assembly blocks = geom::grid({0.6, 0.3, 0.3}, {2, 1, 1}, {-0.2, -0.15, -0.6});
  cdem::Simulation s =
      on_wall(geom::shell_mesh(drum, 0.1, Vec3(0, 0, 0)), blocks, cdem::Element::finite_volume);
  s.gravity(gravity());
  cdem::RunOptions options = over_time(2);
  options.local_damping = 0.2;
  s.run(options);
  for (const cdem::Unit& unit : cdem::units_of(s.model(), s.state(), "blocks")) {
    const Vec3& x = unit.centroid;
    CHECK(std::hypot(x.x(), x.z()) < r - 0.14); // half a block from its side
    CHECK(x.z() < -0.3);
  }
  CHECK(s.reaction(body_of("wall")).z() ==
        Approx(2 * 0.027 * rock().density * earth_pull +
               geom::volume(geom::shell_mesh(drum, 0.1, Vec3(0, 0, 0))) * rock().density * earth_pull)
            .epsilon(0.05));
}
