// A mesh of parts that do not hang together is that many bodies: each moves, touches the others and turns by itself.
#include "libcdem/results/energy.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace testing;
using geom::Vec3;

namespace {

geom::TetMesh together(const std::vector<geom::TetMesh>& meshes) {
  geom::TetMesh all;
  for (const geom::TetMesh& mesh : meshes) {
    const int first = static_cast<int>(all.nodes.size());
    all.nodes.insert(all.nodes.end(), mesh.nodes.begin(), mesh.nodes.end());
    for (geom::Tet tet : mesh.tets) {
      for (int& node : tet)
        node += first;
      all.tets.push_back(tet);
    }
    all.region.insert(all.region.end(), mesh.region.begin(), mesh.region.end());
  }
  return all;
}

// Three boxes at odd angles, one above the other, over a plate.
geom::TetMesh loose_units() {
  const auto unit = [](double x, double z, double angle) {
    return box_at({0.5, 0.4, 0.3}, {2, 2, 2}, rotation({1, 2, 0.5}, angle * degree), {x, 0, z});
  };
  return together({unit(0, 0.35, 20), unit(0.05, 0.95, -35), unit(-0.05, 1.6, 60)});
}

cdem::BodySpec floor_plate() {
  cdem::BodySpec plate =
      meshed("floor", box_at({4, 4, 0.3}, {4, 4, 1}, geom::Mat3::Identity(), {0, 0, -0.15}), {}, soft_rock());
  plate.element = cdem::Element::rigid;
  return plate;
}

} // namespace

TEST_CASE("the parts of a mesh are blocks of their own, of the same body", "[mesh_parts]") {
  const bool rigid = GENERATE(false, true);
  cdem::BodySpec spec = meshed("units", loose_units(), {}, soft_rock());
  if (rigid)
    spec.element = cdem::Element::rigid;
  System s(build({spec}));
  REQUIRE(s.model.blocks.size() == 3);
  CHECK(s.model.rigid.size() == (rigid ? 3u : 0u));
  double volume = 0;
  for (const cdem::Block& block : s.model.blocks) {
    CHECK(block.body == 0);
    volume += block.mass.volume;
  }
  CHECK(volume == Approx(3 * 0.5 * 0.4 * 0.3));
}

TEST_CASE("loose units of one mesh fall, land on each other and on the floor, and come to rest",
          "[mesh_parts]") {
  const bool rigid = GENERATE(false, true);
  cdem::BodySpec units = meshed("units", loose_units(), {}, soft_rock());
  if (rigid)
    units.element = cdem::Element::rigid;
  System s(
      build({floor_plate(), units}, {{"floor", "units", friction(40)}, {"units", "units", friction(30)}}));
  REQUIRE(s.model.blocks.size() == 4);
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 6; // the highest may stand on an edge for some seconds before it tips
  options.local_damping = 0.3;
  s.run(options);
  for (int b = 1; b < 4; ++b) {
    INFO("unit " << b);
    CHECK(lowest(s, b) > -0.01);
    CHECK(centroid(s, b).z() < 1.0); // the highest began at 1.6 m
    CHECK(vec(s.state.velocity[s.model.blocks[b].node_begin]).norm() < 0.05);
  }
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-2);
  // Nothing holds them together: they have turned by themselves, and no two have moved alike.
  const Vec3 a = centroid(s, 1), b = centroid(s, 2), c = centroid(s, 3);
  CHECK(((b - a) - Vec3(0.05, 0, 0.6)).norm() > 0.05);
  CHECK(((c - b) - Vec3(-0.1, 0, 0.65)).norm() > 0.05);
}

TEST_CASE("parts of one mesh that touch from the start rest on each other, at any attitude", "[mesh_parts]") {
  const geom::Mat3 turn = GENERATE(geom::Mat3(geom::Mat3::Identity()), rotation({1, 2, -0.5}, 77 * degree));
  const auto slab = [&](double z) {
    return placed(geom::box_mesh({1, 1, 0.4}, {3, 3, 2}, 0.1), turn, turn * Vec3(0.02 * z, 0, z));
  };
  System s(build({meshed("stack", together({slab(0), slab(0.4), slab(0.8)}), {}, soft_rock())},
                 {{"stack", "stack", friction(30)}}));
  REQUIRE(s.model.blocks.size() == 3);
  s.hold(cdem::Selection::where([turn](const Vec3& x) { return (turn.transpose() * x).z() < 0.01; }, "foot"),
         "xyz");
  s.conditions.gravity = gravity(turn * Vec3(0, 0, -9.81));
  cdem::RunOptions options;
  options.duration = 0.3;
  options.local_damping = 0.3;
  s.run(options);
  for (int b = 1; b < 3; ++b) {
    const Vec3 moved = turn.transpose() * centroid(s, b) - Vec3(0.5 + 0.02 * 0.4 * b, 0.5, 0.4 * b + 0.2);
    INFO("slab " << b << " moved by " << moved.transpose());
    CHECK(moved.norm() < 5e-3);
    CHECK(moved.z() < 0);
  }
}

TEST_CASE("two parts of a mesh that meet without a law say which is missing, and a joint brings its friction",
          "[mesh_parts]") {
  const auto thrown_at_each_other = [](const cdem::Bonding& bonding) {
    const auto cube = [](double x) {
      return box_at({1, 1, 1}, {2, 2, 2}, geom::Mat3::Identity(), {x, 0, 0});
    };
    cdem::ModelSpec spec;
    cdem::Joint strong = rock_joint();
    strong.cohesion = strong.tensile_strength = 1e12;
    spec.bodies = {meshed("pair", together({cube(0), cube(1.05)}), bonding, soft_rock(), strong)};
    cdem::Simulation s(spec, 1, nullptr);
    s.initial_velocity(cdem::Selection::in_box({{-1, -1, -1}, {0.52, 1, 1}}), {2, 0, 0});
    cdem::RunOptions options;
    options.duration = 0.06;
    s.run(options);
    return s.mean("velocity.x", cdem::Selection::in_box({{0.53, -1, -1}, {2, 1, 1}}));
  };
  CHECK_THROWS_WITH(thrown_at_each_other({}), Catch::Contains("add {\"pair\", \"pair\", cdem.coulomb"));
  cdem::Bonding bonding;
  bonding.everywhere = true;
  CHECK(thrown_at_each_other(bonding) > 1); // the second cube was pushed on
}

TEST_CASE("parts of a mesh keep the faces that were named on it", "[mesh_parts]") {
  geom::TetMesh mesh = loose_units();
  const auto outer = geom::outer_faces(mesh);
  mesh.named["all"] = {};
  for (int f = 0; f < static_cast<int>(outer.size()); ++f)
    mesh.named["all"].push_back(f);
  System s(build({meshed("units", mesh, {}, soft_rock())}));
  const auto& named = s.model.mesh.named.at({0, "all"});
  CHECK(named.size() == s.model.mesh.boundary.size());
  CHECK(std::set<int>(named.begin(), named.end()).size() == outer.size());
}
