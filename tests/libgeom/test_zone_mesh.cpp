// Zones fill their block, end on its faces and have about the size asked for; blocks as one solid share their faces.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/star_mesh.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/meshing/zone_mesh.hpp"

#include <catch2/catch.hpp>

using namespace geom;

namespace {

double tet_volume(const BlockMesh& mesh, const Tet& t) {
  const auto& x = mesh.nodes;
  return (x[t[1]] - x[t[0]]).dot((x[t[2]] - x[t[0]]).cross(x[t[3]] - x[t[0]])) / 6;
}

Assembly cells(int count) {
  VoronoiOptions options;
  options.count = count;
  options.seed = 5;
  return voronoi(options);
}

} // namespace

TEST_CASE("zones fill their block and tile each of its faces", "[zones]") {
  const std::vector<Polyhedron> blocks = cells(12).blocks;
  const std::vector<BlockMesh> meshes = zone_meshes(blocks, 0.15);
  REQUIRE(meshes.size() == blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const BlockMesh& mesh = meshes[b];
    INFO("block " << b << " of " << mesh.tets.size() << " tets");
    CHECK(mesh.tets.size() > 12);
    double volume = 0;
    for (const Tet& tet : mesh.tets) {
      CHECK(tet_volume(mesh, tet) > 0);
      volume += tet_volume(mesh, tet);
    }
    CHECK(volume == Approx(mass_properties(blocks[b]).volume).epsilon(1e-9));
    for (std::size_t v = 0; v < blocks[b].vertices.size(); ++v)
      CHECK(mesh.nodes[v] == blocks[b].vertices[v]);
    REQUIRE(mesh.fans.size() == blocks[b].faces.size());
    for (int f = 0; f < static_cast<int>(mesh.fans.size()); ++f) {
      Vec3 area = Vec3::Zero();
      REQUIRE(mesh.fans[f].size() == mesh.fan_tets[f].size());
      for (std::size_t i = 0; i < mesh.fans[f].size(); ++i) {
        const Triangle& t = mesh.fans[f][i];
        area += 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]);
        const Tet& tet = mesh.tets[mesh.fan_tets[f][i]];
        for (const int node : t)
          CHECK(std::count(tet.begin(), tet.end(), node) == 1);
      }
      CHECK((area - face_area(blocks[b], f) * face_normal(blocks[b], f)).norm() < 1e-9);
    }
  }
}

TEST_CASE("half the zone size makes about eight times the zones, and the same each time", "[zones]") {
  const std::vector<Polyhedron> block = {make_box({0, 0, 0}, {1, 1, 1})};
  const auto coarse = zone_meshes(block, 0.25), fine = zone_meshes(block, 0.125),
             again = zone_meshes(block, 0.25);
  const double ratio = static_cast<double>(fine[0].tets.size()) / static_cast<double>(coarse[0].tets.size());
  CHECK(ratio > 5);
  CHECK(ratio < 12);
  CHECK(again[0].tets == coarse[0].tets);
}

TEST_CASE("blocks smaller than a zone, and slivers, are filled by at least their star mesh", "[zones]") {
  VoronoiOptions thin;
  thin.size = {1, 1, 1e-4};
  thin.count = 6;
  std::vector<Polyhedron> blocks = voronoi(thin).blocks;
  blocks.push_back(make_box({0, 0, 0}, {0.1, 0.1, 0.1}));
  const std::vector<BlockMesh> meshes = zone_meshes(blocks, 0.3);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    CHECK(meshes[b].tets.size() >= star_mesh(blocks[b]).tets.size());
    double volume = 0;
    for (const Tet& tet : meshes[b].tets)
      volume += tet_volume(meshes[b], tet);
    CHECK(volume == Approx(mass_properties(blocks[b]).volume).epsilon(1e-6));
  }
}

TEST_CASE("a zone size that is no size, or far too small, is refused", "[zones]") {
  const std::vector<Polyhedron> block = {make_box({0, 0, 0}, {1, 1, 1})};
  CHECK_THROWS_AS(zone_meshes(block, 0), InputError);
  CHECK_THROWS_AS(zone_meshes(block, 0.01), InputError);
}

TEST_CASE("blocks as one solid are its regions in their order, and their mesh shares the faces between them",
          "[zones]") {
  // Courses that lie on halves of each other: faces overlap in part.
  BrickOptions wall;
  wall.size = {2, 0.5, 1};
  wall.brick = {0.8, 0.5, 0.25};
  const Assembly assembly = GENERATE_REF(cells(10), bricks(wall));
  const Solid solid = make_solid(assembly);
  REQUIRE(solid.regions() == static_cast<int>(assembly.blocks.size()));
  const std::vector<double> volumes = region_volumes(solid);
  MeshSize size;
  size.size = 0.25;
  const TetMesh mesh = mesh_solid(solid, size);
  std::vector<double> meshed(assembly.blocks.size(), 0.0);
  std::vector<Vec3> moments(assembly.blocks.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& n = mesh.tets[t];
    const auto& x = mesh.nodes;
    const double v = (x[n[1]] - x[n[0]]).dot((x[n[2]] - x[n[0]]).cross(x[n[3]] - x[n[0]])) / 6;
    meshed[mesh.region[t]] += v;
    moments[mesh.region[t]] += v / 4 * (x[n[0]] + x[n[1]] + x[n[2]] + x[n[3]]);
  }
  for (std::size_t b = 0; b < assembly.blocks.size(); ++b) {
    const MassProperties expected = mass_properties(assembly.blocks[b]);
    CHECK(volumes[b] == Approx(expected.volume).epsilon(1e-6));
    CHECK(meshed[b] == Approx(expected.volume).epsilon(1e-6));
    CHECK((moments[b] / meshed[b] - expected.centroid).norm() < 1e-6);
  }
  double shared = 0, expected = 0; // area between different regions
  for (const InnerFace& face : inner_faces(mesh))
    if (mesh.region[face.tets[0]] != mesh.region[face.tets[1]])
      shared += 0.5 * (mesh.nodes[face.nodes[1]] - mesh.nodes[face.nodes[0]])
                          .cross(mesh.nodes[face.nodes[2]] - mesh.nodes[face.nodes[0]])
                          .norm();
  for (const Polyhedron& block : assembly.blocks)
    for (int f = 0; f < static_cast<int>(block.faces.size()); ++f)
      expected += 0.5 * face_area(block, f);
  const Vec3 box = bounding_box(assembly).size();
  expected -= box.x() * box.y() + box.y() * box.z() + box.z() * box.x();
  CHECK(shared == Approx(expected).epsilon(1e-6));
}
