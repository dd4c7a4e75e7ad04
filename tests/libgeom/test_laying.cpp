// Layers of units with flat sides, and of units from a file.
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/triangle_distance.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/solid/armour_units.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include <fstream>
#include <omp.h>

using namespace geom;

namespace {

// 40 m by 20 m, two in three.
Ground breakwater_slope() {
  TetMesh mesh = box_mesh({40, 20, 1}, {2, 2, 1});
  for (Vec3& x : mesh.nodes) {
    x.y() -= 10;
    x.z() += x.x() / 1.5 - 1;
  }
  return Ground(surface_of(mesh));
}

// From each other and from the ground.
double least_clearance(const Pile& pile, const Ground& ground, double limit) {
  double least = limit;
  std::vector<Surface> units;
  for (const TetMesh& mesh : meshes(pile)) {
    units.push_back(surface_of(mesh));
    least = std::min(least, distance(units.back(), ground.surface(), limit));
    for (std::size_t i = 0; i + 1 < units.size(); ++i)
      least = std::min(least, distance(units[i], units.back(), limit));
  }
  return least;
}

void write_stl(const Surface& surface, const std::string& path) {
  std::ofstream out(path);
  out.precision(9);
  out << "solid unit\n";
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : surface.corners(i))
      out << "vertex " << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid unit\n";
}

} // namespace

TEST_CASE("a layer of thirty cubes comes to rest, clear of each other, nearly all on three supports") {
  LayerOptions options;
  options.columns = 6;
  const Ground ground = breakwater_slope();
  const Layer layer = place_layer(box_mesh({1, 1, 1}, {1, 1, 1}), 30, ground, options);
  CHECK(layer.at_rest);
  // Without walls the ends of five rows are open.
  CHECK(layer.leaning.size() + layer.put_back.size() < 8);
  CHECK(least_clearance(layer.pile, ground, 0.01) >= 0.99 * 2e-5);
}

TEST_CASE("a unit from an STL file is laid as its own solid is") {
  const TemporaryFolder folder;
  const std::string path = folder / "unit.stl";
  write_stl(surface_of(mesh_solid(accropode(1), {0.4})), path);
  const TetMesh unit = mesh_solid(make_solid(read_stl(path)), {0.4});
  LayerOptions options;
  options.columns = 4;
  options.walls = true;
  const Ground ground = breakwater_slope();
  const Layer layer = place_layer(unit, 12, ground, options);
  CHECK(layer.at_rest);
  CHECK(layer.leaning.empty());
  CHECK(layer.put_back.empty());
  CHECK(least_clearance(layer.pile, ground, 0.01) >= 0.99 * 2e-5);
}

TEST_CASE("who watches a layer being repositioned is told how many units lack a support, ever fewer") {
  LayerOptions options;
  options.columns = 6;
  std::vector<int> told;
  options.tell = [&](const LayerProgress& now) {
    if (now.unsupported > 0)
      told.push_back(now.unsupported);
  };
  const Layer layer = place_layer(box_mesh({1, 1, 1}, {1, 1, 1}), 18, breakwater_slope(), options);
  REQUIRE(!told.empty());
  CHECK(std::is_sorted(told.rbegin(), told.rend()));
  CHECK(told.size() < 4000); // it ends
  CHECK(layer.leaning.size() <= static_cast<std::size_t>(told.front()));
}

TEST_CASE("layers are the same with one thread and with several") {
  LayerOptions options;
  options.columns = 4;
  const int layers = GENERATE(1, 2);
  const auto laid = [&](int threads) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    options.layers = layers;
    Layer layer = place_layer(box_mesh({1, 1, 1}, {1, 1, 1}), 10 * layers, breakwater_slope(), options);
    omp_set_num_threads(before);
    return layer;
  };
  const Layer one = laid(1), three = laid(3);
  REQUIRE(one.pile.poses.size() == three.pile.poses.size());
  for (std::size_t i = 0; i < one.pile.poses.size(); ++i) {
    CHECK(one.pile.poses[i].translation == three.pile.poses[i].translation);
    CHECK(one.pile.poses[i].rotation == three.pile.poses[i].rotation);
  }
}
