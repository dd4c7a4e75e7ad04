// Layers of units with flat sides, and of units from a file.
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/solid_mesh.hpp"
#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/placement/features.hpp"
#include "libgeom/query/triangle_distance.hpp"
#include "libgeom/solid/armour_units.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "tests/libgeom/box_surface.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>

using namespace geom;
using testing::box_surface;

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

TEST_CASE("cubes side by side on a plane push on each other's sides where one has entered the other") {
  // By 1e-3, and 1e-6 lower or higher: the corners that entered are next to the lower or the upper face.
  for (const double lower : {1e-6, -1e-6}) {
    const Features one = features_of(box_surface({1, 1, 1})),
                   other = features_of(box_surface({1, 1, 1}, {0.999, 0.3, -lower}));
    std::vector<Touch> touches;
    NearFeatures(one, other, 0.01).touches(one, other, 0.01, touches);
    int sideways = 0;
    for (const Touch& touch : touches)
      if (touch.gap < 0) {
        CHECK(std::abs(touch.normal.x()) == Approx(1).epsilon(1e-6));
        CHECK(touch.gap == Approx(-1e-3).epsilon(1e-6));
        ++sideways;
      }
    CHECK(sideways >= 3);
  }
}

TEST_CASE("a layer of thirty cubes comes to rest, clear of each other, nearly all on three supports") {
  LayerOptions options;
  options.columns = 6;
  const Ground ground = breakwater_slope();
  const Layer layer = place_layer(box_mesh({1, 1, 1}, {1, 1, 1}), 30, ground, options);
  CHECK(layer.at_rest);
  // The ends of five rows are open, without walls.
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
