// Solids: volumes and inertia by formula, and the algebra of boolean operations.
#include "libgeom/core/error.hpp"
#include "libgeom/solid/solid.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>

using namespace geom;
using Catch::Matchers::Contains;

namespace {

double volume(const Solid& solid) {
  return mass_properties(solid).volume;
}

const Solid& left() {
  static const Solid solid = box({1, 2, 3}, {0, 0, 0});
  return solid;
}
const Solid& right() {
  static const Solid solid = box({1, 2, 3}, {0.5, 0, 0});
  return solid;
}

} // namespace

TEST_CASE("primitives have the volume and inertia of their formulas") {
  const MassProperties b = mass_properties(left());
  CHECK(b.volume == Approx(6).epsilon(1e-12));
  CHECK(b.inertia(0, 0) == Approx(6 * (4 + 9) / 12.).epsilon(1e-10));
  CHECK((b.centroid - Vec3(0.5, 1, 1.5)).norm() < 1e-12);
  CHECK(volume(cylinder({1, 2, 3}, {0, 0, 2}, 0.5)) == Approx(M_PI * 0.25 * 2).epsilon(1e-9));
  CHECK(volume(cone({0, 0, 0}, {1, 0, 0}, 0.5, 0)) == Approx(M_PI * 0.25 / 3).epsilon(1e-9));
  CHECK(volume(cone({0, 0, 0}, {0, 1, 0}, 0.5, 0.2)) == Approx(M_PI * (0.25 + 0.1 + 0.04) / 3).epsilon(1e-9));
  CHECK(volume(cone({0, 0, 0}, {0, 1, 0}, 0.5, 0.5)) == Approx(M_PI * 0.25).epsilon(1e-9));
  const MassProperties s = mass_properties(sphere({1, 0, 0}, 2));
  CHECK(s.volume == Approx(4 * M_PI * 8 / 3).epsilon(1e-9));
  CHECK(s.inertia(2, 2) == Approx(0.4 * s.volume * 4).epsilon(1e-6));
}

TEST_CASE("a union has the volume of both less what they have in common") {
  CHECK(volume(united({left(), right()})) == Approx(9).epsilon(1e-10));
  CHECK(volume(common(left(), right())) == Approx(3).epsilon(1e-10));
  CHECK(volume(cut(left(), {right()})) == Approx(3).epsilon(1e-10));
  CHECK(united({left(), right()}).regions() == 1);
}

TEST_CASE("a box less a ball that pokes through its faces has a volume by formula") {
  const double r = 1.2, h = 1;                                   // ball's radius; distance of the six faces
  const double cap = M_PI * (r - h) * (r - h) * (2 * r + h) / 3; // of the ball beyond one face
  const Solid rest = cut(box({2, 2, 2}, {-1, -1, -1}), {sphere({0, 0, 0}, r)});
  CHECK(volume(rest) == Approx(8 - (4 * M_PI * r * r * r / 3 - 6 * cap)).epsilon(1e-6));
}

TEST_CASE("fragments hold every point once, as regions") {
  const Solid pieces = fragments({left(), right()});
  CHECK(pieces.regions() == 3);
  CHECK(volume(pieces) == Approx(9).epsilon(1e-10));
  for (const double v : region_volumes(pieces))
    CHECK(v == Approx(3).epsilon(1e-10));
  const double ixx = 9 * (4 + 9) / 12.; // of the 1.5 x 2 x 3 box they fill
  CHECK(mass_properties(pieces).inertia(0, 0) == Approx(ixx).epsilon(1e-10));
}

TEST_CASE("what has nothing left says so") {
  CHECK_THROWS_WITH(common(left(), box({1, 1, 1}, {9, 9, 9})), "common part: nothing is left");
  CHECK_THROWS_WITH(cut(left(), {box({9, 9, 9}, {-1, -1, -1})}), "cut: nothing is left");
}

TEST_CASE("moving and turning keep volume, scaling multiplies it by the cube") {
  const Solid body = united({left(), cylinder({0.5, 1, 2}, {0, 0, 3}, 0.3)});
  const double v = volume(body);
  CHECK(volume(translated(body, {5, 6, 7})) == Approx(v).epsilon(1e-9));
  CHECK(
      (mass_properties(translated(body, {5, 6, 7})).centroid - mass_properties(body).centroid - Vec3(5, 6, 7))
          .norm() < 1e-9);
  CHECK(volume(rotated(body, {1, 2, 3}, 0.7, {1, 1, 1})) == Approx(v).epsilon(1e-9));
  const Solid large = scaled(body, 2.5, {1, 0, 0});
  CHECK(volume(large) == Approx(v * std::pow(2.5, 3)).epsilon(1e-9));
  const Vec3 expected = Vec3(1, 0, 0) + 2.5 * (mass_properties(body).centroid - Vec3(1, 0, 0));
  CHECK((mass_properties(large).centroid - expected).norm() < 1e-8);
}

TEST_CASE("a solid turned by a quarter about z has its x along y") {
  const Box turned = bounding_box(rotated(left(), {0, 0, 2}, M_PI / 2, {0, 0, 0}));
  CHECK((turned.min - Vec3(-2, 0, 0)).norm() < 1e-6);
  CHECK((turned.max - Vec3(0, 1, 3)).norm() < 1e-6);
}

TEST_CASE("a STEP file comes back with its size in metres") {
  const TemporaryFolder folder;
  Solid again = left();
  for (int i = 0; i < 2; ++i) { // what was read before does not change how files are written
    write_step(again, folder / "box.step");
    again = read_step(folder / "box.step");
    CHECK(volume(again) == Approx(6).epsilon(1e-9));
    CHECK((bounding_box(again).max - Vec3(1, 2, 3)).norm() < 1e-6);
  }
}

TEST_CASE("a STEP file that is missing or none is refused") {
  const TemporaryFolder folder;
  std::ofstream(folder / "bad.step") << "this is no STEP file\n";
  CHECK_THROWS_WITH(read_step(folder / "none.step"), Contains("an existing STEP file"));
  CHECK_THROWS_AS(read_step(folder / "bad.step"), InputError);
  CHECK(volume(box({1, 1, 1}, {0, 0, 0})) == Approx(1)); // and the kernel still works
}

TEST_CASE("primitives refuse sizes that are none") {
  const double nan = std::nan("");
  CHECK_THROWS_WITH(sphere({0, 0, 0}, -1), "radius = -1: must be from 0.1 mm to 100 km");
  CHECK_THROWS_AS(cylinder({0, 0, 0}, {0, 0, 0}, 1), InputError);
  CHECK_THROWS_AS(cylinder({nan, 0, 0}, {0, 0, 1}, 1), InputError);
  CHECK_THROWS_AS(cone({0, 0, 0}, {0, 0, 1}, 0, 0), InputError);
  CHECK_THROWS_AS(box({1, 1, 1}, {1e7, 0, 0}), InputError);
  CHECK_THROWS_AS(rotated(left(), {0, 0, 0}, 1, {0, 0, 0}), InputError);
  CHECK_THROWS_AS(scaled(left(), 0, {0, 0, 0}), InputError);
}
