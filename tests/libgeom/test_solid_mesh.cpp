// Meshes of solids: they fill the solid, share faces, repeat, and failures leave nothing behind.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/tet_quality.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/solid/armour_units.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <clocale>
#include <cmath>
#include <fstream>
#include <iostream>
#include <set>

#include <omp.h>

using namespace geom;
using Catch::Matchers::Contains;

namespace {

double solid_volume(const Solid& solid) {
  return mass_properties(solid).volume;
}

void write_triangles(const std::string& path, const std::vector<std::array<Vec3, 3>>& triangles) {
  std::ofstream out(path);
  out.precision(17);
  out << "solid test\n";
  for (const auto& t : triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : t)
      out << "vertex " << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid test\n";
}

// Fans of a polyhedron's faces.
std::vector<std::array<Vec3, 3>> triangles_of(const Polyhedron& p) {
  std::vector<std::array<Vec3, 3>> out;
  for (const PolyhedronFace& face : p.faces)
    for (std::size_t i = 2; i < face.loop.size(); ++i)
      out.push_back({p.vertices[face.loop[0]], p.vertices[face.loop[i - 1]], p.vertices[face.loop[i]]});
  return out;
}

// A block with a deep groove whose lips reach through each other: closed and oriented, yet it cuts itself.
std::vector<std::array<Vec3, 3>> self_intersecting() {
  Polyhedron p = make_box({0, 0, 0}, {1, 1, 1});
  for (Vec3& x : p.vertices)
    if (x.z() > 0)
      x = Vec3(1 - x.x(), 1 - x.y(), x.z()); // the top is turned by half a turn: the sides cross
  return triangles_of(p);
}

} // namespace

TEST_CASE("the mesh of flat faces fills the solid exactly") {
  const Solid unit = accropode(1);
  CHECK(volume(mesh_solid(unit, {0.12})) == Approx(solid_volume(unit)).epsilon(1e-10));
}

TEST_CASE("the mesh of a ball lacks the segments between chords and sphere, an error of second order") {
  const Solid ball = sphere({0, 0, 0}, 1);
  const double exact = solid_volume(ball);
  const double coarse = 1 - volume(mesh_solid(ball, {0.3})) / exact;
  const double fine = 1 - volume(mesh_solid(ball, {0.15})) / exact;
  CHECK(coarse > 0);
  CHECK(fine > 0);
  CHECK(coarse / fine > 3);
  CHECK(fine <
        0.15 *
            0.15); // h^2 / (4 R^2) for chords, times 3 R for the shell over the volume, and edges up to 1.5 h
}

TEST_CASE("meshes of armour units have no slivers") {
  for (const Solid& unit : {accropode(1), accropode(1, AccropodeShape::stocky()), dolos(1), tetrapod(1),
                            antifer(1), cubipod(1)}) {
    const MeshQuality q = quality(mesh_solid(unit, {0.08}));
    CHECK(q.min_radius_ratio > 0.15);
    CHECK(q.mean_radius_ratio > 0.65);
    CHECK(q.min_dihedral > 6 * M_PI / 180);
    CHECK(q.tets > 1000);
  }
}

TEST_CASE("meshing twice gives the same mesh") {
  const Solid unit = accropode(1.81, AccropodeShape::stocky());
  const TetMesh a = mesh_solid(unit, {0.2});
  mesh_solid(dolos(1), {0.2}); // what was meshed in between does not matter
  const TetMesh b = mesh_solid(unit, {0.2});
  CHECK(a.tets == b.tets);
  CHECK(a.nodes == b.nodes);
}

TEST_CASE("similar units have similar meshes") {
  const TetMesh small = mesh_solid(accropode(1), {0.1}), large = mesh_solid(accropode(2), {0.2});
  CHECK(double(large.tets.size()) == Approx(double(small.tets.size())).epsilon(0.05));
}

TEST_CASE("regions of fragments share the nodes of their common face") {
  const TetMesh mesh = mesh_solid(fragments({box({1, 1, 1}, {0, 0, 0}), box({1, 1, 1}, {1, 0, 0})}), {0.3});
  std::array<std::set<int>, 2> nodes;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    nodes[mesh.region[t]].insert(mesh.tets[t].begin(), mesh.tets[t].end());
  std::size_t shared = 0;
  for (const int node : nodes[0])
    if (nodes[1].count(node) > 0) {
      ++shared;
      CHECK(mesh.nodes[node].x() == Approx(1).margin(1e-9));
    }
  CHECK(shared >= 16); // at least 4 x 4 on a 1 m face at 0.3 m
  const auto faces = outer_faces(mesh);
  CHECK(faces_on_plane(mesh, faces, {Vec3::UnitX(), 1}, 1e-9).empty()); // no outer face inside
  CHECK(measure(mesh, faces, faces_on_side(mesh, faces, "y-")).area == Approx(2));
}

TEST_CASE("tets are small where asked and coarse elsewhere") {
  MeshSize sizes{0.25};
  sizes.refinements.push_back({{Vec3(0, 0, 0)}, {}, 0.04, 0.1});
  const TetMesh mesh = mesh_solid(box({1, 1, 1}, {0, 0, 0}), sizes);
  double near = 0, far = 0;
  for (const Tet& t : mesh.tets) {
    const Vec3 centre = 0.25 * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]);
    double longest = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        longest = std::max(longest, (mesh.nodes[t[i]] - mesh.nodes[t[j]]).norm());
    (centre.norm() < 0.1 ? near : far) = std::max(centre.norm() < 0.1 ? near : far, longest);
  }
  CHECK(near > 0);
  CHECK(near < 0.1);
  CHECK(far > 0.2);
  CHECK(far < 0.6);
}

TEST_CASE("a solid that cannot be meshed says so, and the next one is meshed as ever") {
  const Solid good = accropode(1);
  const std::size_t before = mesh_solid(good, {0.15}).tets.size();
  const TemporaryFolder folder;
  write_triangles(folder / "knot.stl", self_intersecting());
  for (int i = 0; i < 2; ++i) {
    CHECK_THROWS_AS(mesh_solid(make_solid(read_stl(folder / "knot.stl")), {0.2}), InputError);
    CHECK(mesh_solid(good, {0.15}).tets.size() == before);
  }
}

TEST_CASE("meshing leaves the process's threads, locale and output as they were") {
  const int threads = omp_get_max_threads();
  const std::string locale = std::setlocale(LC_ALL, nullptr);
  omp_set_num_threads(3);
  mesh_solid(cube(1), {0.5});
  CHECK_THROWS(mesh_solid(cube(1), {-1}));
  CHECK_THROWS(read_step("none.step"));
  CHECK(omp_get_max_threads() == 3);
  CHECK(std::setlocale(LC_ALL, nullptr) == locale);
  CHECK(std::cout.good());
  omp_set_num_threads(threads);
}

TEST_CASE("sizes that ask for too many tets or none are refused") {
  const Solid cube = box({1, 1, 1}, {0, 0, 0});
  CHECK_THROWS_WITH(mesh_solid(cube, {1e-4}), Contains("at most 20 million tetrahedra"));
  CHECK_THROWS_WITH(mesh_solid(cube, {-1}), "size = -1: must be finite and > 0 m");
  CHECK_THROWS_AS(mesh_solid(cube, {std::nan("")}), InputError);
}
