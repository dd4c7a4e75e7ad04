// Porosity, density and thickness of arrays of cubes, whose columns can be counted by hand.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/placement/pile.hpp"
#include "libgeom/placement/pile_measures.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using Catch::Matchers::Contains;

namespace {

// n x n cubes of 1 m, `pitch` apart, standing on z = 0 and turned with it by `motion`.
struct Array {
  std::vector<Surface> units;
  Surface ground;
};

Array cubes(int n, double pitch, const Pose& motion = {}, double cube_height = 1) {
  Array array;
  const auto add = [&](TetMesh mesh) {
    for (Vec3& x : mesh.nodes)
      x = motion(x);
    return surface_of(mesh);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      TetMesh cube = box_mesh({1, 1, cube_height}, {1, 1, 1});
      for (Vec3& x : cube.nodes)
        x += Vec3(i * pitch, j * pitch, 0);
      array.units.push_back(add(cube));
    }
  TetMesh ground = box_mesh({n * pitch + 2, n * pitch + 2, 1}, {1, 1, 1});
  for (Vec3& x : ground.nodes)
    x -= Vec3(1, 1, 1);
  array.ground = add(ground);
  return array;
}

// The middle of the array reaches from the inner face of its first row to that of its last: n - 2 cubes and
// n - 1 gaps in each direction.
double covered(int n, double pitch) {
  const double share = (n - 2) / ((n - 1) * pitch - 1);
  return share * share;
}

} // namespace

TEST_CASE("an array of cubes has the porosity, density and thickness of its columns", "[pile]") {
  const Mat3 tilt = Eigen::AngleAxisd(-0.5, Vec3::UnitY()).toRotationMatrix();
  for (const Pose& motion : {Pose{}, Pose{tilt, {3, -2, 11}}})
    for (const double pitch : {1.25, 1.6}) {
      constexpr int n = 6;
      const Array array = cubes(n, pitch, motion);
      const PileMeasures m = measure_pile(array.units, array.ground, 1, 1);
      const double share = covered(n, pitch), side = (n - 1) * pitch - 1;
      // The edge of the middle and of each cube is met to one column of 1/40 m.
      CHECK(m.thickness == Approx(1).epsilon(1e-9));
      CHECK(m.porosity == Approx(1 - share).margin(2. / 40 * 4 / side));
      CHECK(m.units_per_area == Approx(share).margin(2. / 40 * 4 / side));
      CHECK(m.packing_density == Approx(m.units_per_area));
      CHECK(m.area == Approx(side * side).epsilon(0.03));
      CHECK(m.porosity_error < 0.03);
    }
}

TEST_CASE("the density of a layer counts all of its solid, the porosity that below its mean top", "[pile]") {
  // Cubes of 1 m and prisms twice as high by turns: mean top 1.5 m where half of the hit columns are of each, solid
  // below it 1.25 m of 1.5 m, and the density of 1.5 cubes a place.
  constexpr int n = 8;
  const double pitch = 1.25;
  Array array = cubes(n, pitch);
  const Array high = cubes(n, pitch, {}, 2);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if ((i + j) % 2 == 0)
        array.units[i * n + j] = high.units[i * n + j];
  const PileMeasures m = measure_pile(array.units, array.ground, 1, 1);
  const double share = covered(n, pitch);
  CHECK(m.thickness == Approx(1.5).epsilon(0.02));
  CHECK(m.porosity == Approx(1 - share * 1.25 / 1.5).margin(0.02));
  CHECK(m.units_per_area == Approx(1.5 * share).epsilon(0.03));
}

TEST_CASE("where units reach into each other the place counts once", "[pile]") {
  Array array = cubes(6, 1.25);
  const PileMeasures once = measure_pile(array.units, array.ground, 1, 1);
  const std::vector<Surface> copy = array.units;
  array.units.insert(array.units.end(), copy.begin(), copy.end());
  const PileMeasures twice = measure_pile(array.units, array.ground, 1, 1);
  CHECK(twice.porosity == once.porosity);
  CHECK(twice.units_per_area == once.units_per_area);
}

TEST_CASE("measures do not depend on the size of the pile", "[pile]") {
  const Array array = cubes(6, 1.3);
  Array large = array;
  for (Surface& unit : large.units)
    for (Vec3& x : unit.points)
      x *= 2;
  for (Vec3& x : large.ground.points)
    x *= 2;
  const PileMeasures m = measure_pile(array.units, array.ground, 1, 1),
                     l = measure_pile(large.units, large.ground, 2, 8);
  CHECK(l.porosity == Approx(m.porosity).epsilon(1e-9));
  CHECK(l.packing_density == Approx(m.packing_density).epsilon(1e-9));
  CHECK(l.thickness == Approx(2 * m.thickness).epsilon(1e-9));
}

TEST_CASE("a pile without a middle, or beside its ground, is refused", "[pile]") {
  const Array two = cubes(2, 1.25), six = cubes(6, 1.25);
  CHECK_THROWS_WITH(measure_pile(two.units, two.ground, 1, 1), Contains("the pile has no middle"));
  CHECK_THROWS_WITH(measure_pile({}, two.ground, 1, 1), Contains("no units"));
  CHECK_THROWS_WITH(measure_pile(six.units, two.ground, 1, 1), Contains("beside its ground"));
}
