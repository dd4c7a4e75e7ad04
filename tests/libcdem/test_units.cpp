// Units of a body: chosen by number, followed as they move, counted where they touch.
#include "libcdem/results/units.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double gap = 1e-5; // m, between cubes that stand on each other

geom::TetMesh unit_at(const Vec3& size, const Vec3& corner) {
  geom::TetMesh mesh = geom::box_mesh(size, {1, 1, 1});
  for (Vec3& x : mesh.nodes)
    x += corner;
  return mesh;
}

// Three cubes of 1 m: two on top of each other, one beside them, on a held slab.
System cubes_on_slab() {
  cdem::BodySpec slab = meshed("slab", unit_at({6, 6, 1}, {-1, -1, -1}));
  slab.element = cdem::Element::rigid;
  cdem::BodySpec units = meshed("units", unit_at({1, 1, 1}, {0, 0, gap}));
  units.meshes.push_back(unit_at({1, 1, 1}, {0.1, 0.2, 1 + 2 * gap}));
  units.meshes.push_back(unit_at({1, 1, 1}, {2, 2, gap}));
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 35 * degree;
  System s(build({slab, units}, {{"slab", "units", law}, {"units", "units", law}}));
  s.hold(cdem::Selection::of_body("slab"), "xyz");
  return s;
}

} // namespace

TEST_CASE("units that rest touch what they stand on and what stands on them", "[units]") {
  System s = cubes_on_slab();
  CHECK(cdem::touching(s.model, s.state, "units") == std::vector<int>{0, 0, 0});
  s.conditions.gravity = cdem::Gravity{};
  s.conditions.gravity->acceleration = {0, 0, -9.81};
  cdem::RunOptions options;
  options.duration = 0.02;
  options.local_damping = 0.5;
  s.run(options);
  CHECK(cdem::touching(s.model, s.state, "units") == std::vector<int>{2, 1, 1});
  CHECK(cdem::touching(s.model, s.state, "slab") == std::vector<int>{2});
}

TEST_CASE("a unit that was turned and moved as a rigid body is found where it is", "[units]") {
  System s = cubes_on_slab();
  const geom::Pose motion{Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).toRotationMatrix(),
                          {4, 5, 6}};
  const cdem::Block& block = s.model.blocks[2];
  for (int n = block.node_begin; n < block.node_end; ++n)
    s.state.displacement[n] = node(motion(s.model.node_position[n]) - s.model.node_position[n]);
  const std::vector<cdem::Unit> units = cdem::units_of(s.model, s.state, "units");
  REQUIRE(units.size() == 3);
  CHECK(units[1].block == 2);
  CHECK((units[1].motion.rotation - motion.rotation).norm() < 1e-12);
  CHECK((units[1].motion.translation - motion.translation).norm() < 1e-12);
  CHECK((units[1].centroid - motion(block.mass.centroid)).norm() < 1e-12);
  CHECK((units[0].motion.rotation - geom::Mat3::Identity()).norm() < 1e-12);

  const std::vector<geom::Surface> surfaces = cdem::surfaces_of(s.model, s.state, "units");
  CHECK(surfaces[1].triangles.size() == 12);
  geom::Box box;
  for (const Vec3& corner : unit_at({1, 1, 1}, {0.1, 0.2, 1 + 2 * gap}).nodes)
    box.extend(motion(corner));
  CHECK((geom::bounding_box(surfaces[1]).min - box.min).norm() < 1e-12);
}

TEST_CASE("a unit that has broken is where its largest piece is, and each piece is closed", "[units]") {
  geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {4, 1, 1});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double x = 0;
    for (const int node : mesh.tets[t])
      x += mesh.nodes[node].x() / 4;
    mesh.region[t] = x > 0.75;
  }
  cdem::Bonding bonding;
  bonding.between_regions = true;
  System s(build({meshed("units", mesh, bonding)}));
  const cdem::Block& block = s.model.blocks[0];
  const geom::Pose large{rotation({1, -2, 0.5}, 40 * degree), {4, 5, 6}},
      small{rotation({0, 1, 0}, 2), {-3, 0, 0}};
  for (std::size_t t = 0; t < s.model.tets.size(); ++t)
    for (const int n : s.model.tets[t])
      s.state.displacement[n] = node((s.model.mesh.region[t] == 0 ? large : small)(s.model.node_position[n]) -
                                     s.model.node_position[n]);
  CHECK(cdem::units_of(s.model, s.state, "units")[0].pieces == 1);
  each_face_spring(s.model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace& at) {
    s.state.faces[at.batch].mode[at.point][at.lane] =
        static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
  });
  const cdem::Unit unit = cdem::units_of(s.model, s.state, "units")[0];
  CHECK(unit.pieces == 2);
  CHECK(unit.largest_piece == Approx(0.75));
  CHECK((unit.motion.rotation - large.rotation).norm() < 1e-12);
  CHECK((unit.motion.translation - large.translation).norm() < 1e-12);
  CHECK((unit.centroid - large(block.mass.centroid)).norm() < 1e-12);

  const geom::Surface surface = cdem::surfaces_of(s.model, s.state, "units")[0];
  CHECK(geom::open_edges(surface).empty());
  double volume = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto [a, b, c] = surface.corners(i);
    volume += a.dot(b.cross(c)) / 6;
  }
  CHECK(volume == Approx(1));
}

TEST_CASE("units chosen by number are their nodes and outer faces alone", "[units]") {
  const System s = cubes_on_slab();
  const auto chosen = cdem::Selection::of_units("units", {3, 1, 3});
  CHECK(chosen.text == "units 1, 3 of body \"units\"");
  for (const int n : cdem::selected_nodes(s.model, chosen))
    CHECK((block_of(s.model, n) == 1 || block_of(s.model, n) == 3));
  CHECK(cdem::selected_nodes(s.model, chosen).size() == 16);
  CHECK(cdem::selected_outer_faces(s.model, chosen).size() == 24);
  CHECK_FALSE(cdem::selects_block(s.model, chosen, 2));
  CHECK_THROWS_AS(cdem::selected_nodes(s.model, cdem::Selection::of_units("units", {4})), geom::InputError);
  CHECK_THROWS_AS(cdem::Selection::of_units("units", {}), geom::InputError);
  CHECK_THROWS_AS(cdem::Selection::of_units("units", {0}), geom::InputError);
}
