// Bare meshes as snapshots: their fields, named faces and shading.
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/mesh_snapshot.hpp"
#include "libcdem/vtk/outline.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace cdem;

namespace {

const geom::TetMesh box = geom::box_mesh({1, 1, 1}, {2, 2, 2});
const auto faces = geom::outer_faces(box);

} // namespace

TEST_CASE("a mesh's snapshot has a value of each field for every tet") {
  const Snapshot s = mesh_snapshot(box, {}, 0.1);
  CHECK(s.surface.size() == 48);
  CHECK(s.block_edges.size() == 24);                          // two along each of twelve edges
  CHECK(mesh_snapshot(box, {}, -1).block_edges.size() == 72); // Euler: 3/2 of the triangles
  for (const SnapshotField& field : s.cell_fields)
    CHECK(field.values.size() == box.tets.size());
  double sum = 0;
  for (const SnapshotField& field : s.cell_fields)
    if (field.name == "volume")
      for (const double v : field.values)
        sum += v;
  CHECK(sum == Approx(1));
}

TEST_CASE("named faces set apart carry their mark on all three corners, all others on none") {
  const NamedFaces named{{"held", geom::faces_on_side(box, faces, "z+")},
                         {"half", geom::faces_on_side(box, faces, "x-")}};
  Snapshot s = mesh_snapshot(box, named, 0.1);
  set_apart(s, faces, named);
  REQUIRE(s.point_fields.size() == 2);
  for (const SnapshotField& field : s.point_fields) {
    REQUIRE(field.values.size() == s.points.size());
    int marked = 0;
    for (const geom::Triangle& t : s.surface) {
      bool on = true;
      for (const int point : t)
        on = on && (field.name == "on_held" ? s.points[point].z() == 1 : s.points[point].x() == 0);
      for (const int point : t)
        REQUIRE(field.values[point] == (on ? 1. : 0.));
      marked += on;
    }
    CHECK(marked == 8);
  }
}

TEST_CASE("a mesh and its regions survive a .vtu") {
  const TemporaryFolder folder;
  geom::TetMesh mesh = box;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.region[t] = static_cast<int>(t % 3);
  write_vtu(mesh_snapshot(mesh, {}, 0.1), folder / "mesh.vtu");
  const geom::TetMesh again = read_vtu_mesh(folder / "mesh.vtu");
  CHECK(again.nodes == mesh.nodes);
  CHECK(again.tets == mesh.tets);
  CHECK(again.region == mesh.region);
  // In the file they count from 1, as in scripts.
  CHECK(find_field(read_vtu(folder / "mesh.vtu").cell_fields, "region")->values[1] == 2);
}

TEST_CASE("the outline of a broken face of a mesh goes from corner to corner") {
  const geom::Vec3 corners[3] = {{0, 0, 0}, {3, 0, 0}, {0, 6, 1}};
  const geom::Vec3 moved(0.1, 0, 0); // m, of the whole face
  BondSnapshot bonds;
  for (int k = 0; k < 3; ++k)
    bonds.points.push_back(2. / 3 * corners[k] + (corners[(k + 1) % 3] + corners[(k + 2) % 3]) / 6);
  bonds.triangles = {{0, 1, 2}};
  const auto broken = static_cast<double>(BondMode::broken_shear);
  bonds.triangle_fields = {{"interface_id", "", 1, {-1}, true}, {"mode", "", 1, {broken}, true}};
  bonds.point_fields = {{"displacement", "m", 3, {.1, 0, 0, .1, 0, 0, .1, 0, 0}, false}};
  const BrokenInterfaces drawn = broken_interfaces(bonds, 10);
  CHECK(drawn.shear.outline.size() == 3);
  for (int k = 0; k < 3; ++k)
    CHECK((drawn.points[k] - corners[k] - 10 * moved).norm() < 1e-12);
}

TEST_CASE("shading changes the colours of ids by less than a sixth") {
  const TemporaryFolder folder;
  PictureOptions options;
  options.field = "region"; // 1 everywhere
  options.view = "iso";
  options.colour_map = "categorical";
  options.colour_bar = options.edges = options.axes = options.legend = false;
  options.size = {300, 300};
  render(mesh_snapshot(box, {}, 0.1), options, folder / "p.png");
  const Image image = read_png(folder / "p.png");
  const double bar = 255 * colour_scale({1}, true, "categorical", {})(1)[0];
  std::set<int> seen;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const bool inside = x > 1 && y > 1 && x + 2 < image.width && y + 2 < image.height &&
                          !image.white(x - 2, y) && !image.white(x + 2, y) && !image.white(x, y - 2) &&
                          !image.white(x, y + 2);
      if (inside)
        seen.insert(image.at(x, y)[0]);
    }
  REQUIRE_FALSE(seen.empty());
  CHECK(*seen.begin() > bar * 5 / 6);
  CHECK(*seen.rbegin() < bar * 7 / 6);
  CHECK(seen.size() >= 3); // yet the three sides differ
}
