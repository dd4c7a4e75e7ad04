// Pressure on the faces of cracks: the opening of a penny-shaped crack, its work, and that of a pumped volume.
#include "libcdem/fracture/free_nodes.hpp"
#include "libcdem/load/crack_pressure.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// A quarter of a block with a round crack of radius 1 m in the plane z = 0, its centre at the origin. Strong, so that the crack
// does not grow.
struct Penny {
  explicit Penny(int cells) : s(build({body_of(cells)})) {
    std::vector<char> nodes(s.model.node_position.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = std::abs(s.model.node_position[i].z()) < 1e-9;
    cdem::Freed freed = cdem::free_nodes(s.model, s.state, nodes);
    s.adopt(std::move(freed.model), std::move(freed.state));
    each_face(s.model.mesh, [&](const cdem::MeshChunk& chunk, std::int64_t batch, int lane) {
      const cdem::FaceNodes at = face_nodes(s.model.mesh, chunk, batch, lane);
      Vec3 centre = Vec3::Zero();
      for (const int n : at.a)
        centre += s.model.node_position[n] / 3;
      if (std::abs(centre.z()) > 1e-9 || centre.norm() > 1)
        return;
      s.state.faces[batch].stage[lane] = cdem::FaceStage::cracking;
      cdem::CohesiveFace& face = s.state.cohesive[batch * cdem::lanes + lane];
      face.plane = {0, 0, 1};
      face.damage = {1, 1, 1};
      for (auto& point : s.state.faces[batch].mode)
        point[lane] = static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
      area += 3 * s.model.mesh.faces[batch].area[lane];
    });
    s.hold(cdem::Selection::side("x-"), "x");
    s.hold(cdem::Selection::side("y-"), "y");
    s.hold(cdem::Selection::side("z-"), "z");
  }

  static cdem::BodySpec body_of(int cells) {
    // Finer at the crack: the places are drawn together towards the origin.
    geom::TetMesh mesh = geom::box_mesh({1, 1, 2}, {cells, cells, 2 * cells}, 0);
    const auto drawn = [](double t) { return 5 * (0.35 * t + 0.65 * t * t * t); };
    for (Vec3& x : mesh.nodes)
      x = Vec3(drawn(x.x()), drawn(x.y()), drawn(x.z() - 1));
    cdem::BodySpec body = concrete_body(std::move(mesh), cdem::Softening::none);
    body.joint.tensile_strength = body.joint.cohesion = 1e12;
    return body;
  }

  void press(cdem::CrackPressure load) {
    s.conditions.crack_pressures = {std::move(load)};
    REQUIRE(s.relax(1e-5).converged);
  }

  double volume() { return cdem::crack_volume(s.model, s.state, cdem::resolve(s.model, s.state, s.conditions.crack_pressures[0])); }

  System s;
  double area = 0; // m2, of the quarter
};

} // namespace

TEST_CASE("crack pressure: a penny-shaped crack opens as Sneddon says", "[crack_pressure]") {
  Penny penny(12);
  const double p = 1e5, e = 30e9 / (1 - 0.04);
  cdem::CrackPressure load;
  load.pressure = [p](double) { return p; };
  penny.press(load);
  // Sneddon 1946: opening 8 p a / (pi E') sqrt(1 - (r / a)^2), volume 16 p a^3 / (3 E'), with the radius of the area that
  // the faces have.
  const double a = std::sqrt(4 * penny.area / pi);
  CHECK(a == Approx(1).epsilon(0.1));
  CHECK(4 * penny.volume() == Approx(16 * p * a * a * a / (3 * e)).epsilon(0.05));
  double above = 0, below = 0;
  for (std::size_t i = 0; i < penny.s.model.node_position.size(); ++i)
    if (penny.s.model.node_position[i].norm() < 1e-9) {
      above = std::max(above, penny.s.state.displacement[i].z);
      below = std::min(below, penny.s.state.displacement[i].z);
    }
  CHECK(above - below == Approx(8 * p * a / (pi * e)).epsilon(0.05));
  // The work of a pressure that is put on at once: p V less what the relaxation throws away, and half of it is stored.
  CHECK(balance(penny.s) < 1e-3);
  CHECK(cdem::energy(penny.s.model, penny.s.state).elastic == Approx(0.5 * p * penny.volume()).epsilon(0.02));
}

TEST_CASE("crack pressure: a fluid of given volume presses by its bulk modulus", "[crack_pressure]") {
  Penny penny(8);
  const double p = 1e5;
  cdem::CrackPressure given;
  given.pressure = [p](double) { return p; };
  penny.press(given);
  const double volume = penny.volume(), bulk = 2.2e9, reservoir = 2 * bulk * volume / p;
  cdem::CrackPressure pumped;
  pumped.volume = [&](double) { return volume + p * reservoir / bulk; };
  pumped.bulk_modulus = bulk;
  pumped.reservoir = reservoir;
  Penny other(8);
  other.press(pumped);
  CHECK(other.volume() == Approx(volume).epsilon(1e-3));
}

TEST_CASE("crack pressure: wrong input is refused", "[crack_pressure][input]") {
  System s(build({meshed("rock", geom::box_mesh({1, 1, 1}, {2, 2, 2}, 0))}));
  cdem::CrackPressure load;
  load.pressure = [](double) { return 1e5; };
  s.conditions.crack_pressures = {load};
  CHECK_THROWS_WITH(s.relax(1e-3), Catch::Contains("a place in a cohesive body"));
}
