// Volumes of armour units against the figures of the trade, and the similarity of sizes.
#include "libgeom/core/error.hpp"
#include "libgeom/solid/armour_units.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;

namespace {

double volume(const Solid& solid) {
  return mass_properties(solid).volume;
}

} // namespace

TEST_CASE("both accropode-like shapes have V = 0.34 H^3 within 1 %") {
  CHECK(volume(accropode(1)) == Approx(0.34).epsilon(0.01));
  CHECK(volume(accropode(1, AccropodeShape::stocky())) == Approx(0.34).epsilon(0.01));
}

TEST_CASE("an accropode fills its height along y and z and is symmetric about three planes") {
  for (const AccropodeShape& shape : {AccropodeShape::slender(), AccropodeShape::stocky()}) {
    const Solid unit = accropode(2, shape);
    const Box box = bounding_box(unit);
    const MassProperties mass = mass_properties(unit);
    CHECK((box.max - Vec3(shape.length, 1, 1)).norm() == Approx(0).margin(1e-6));
    CHECK((box.min + box.max).norm() == Approx(0).margin(1e-6));
    CHECK(mass.centroid.norm() == Approx(0).margin(1e-9));
    CHECK(std::abs(mass.inertia(0, 1)) + std::abs(mass.inertia(1, 2)) + std::abs(mass.inertia(0, 2)) ==
          Approx(0).margin(1e-9));
  }
}

// Half of a bar's section times its length, prisms and frusta by A (1 + t + t^2) / 3 l, and the two corners
// of each end bar that the core fills up.
TEST_CASE("an accropode's volume is that of its core, bars and noses") {
  AccropodeShape s;
  s.width = 0.5;
  s.bar = 0.3;
  s.core = 0.4;
  s.length = 0.9;
  s.taper = 0.6;
  s.corner = GENERATE(0.25, 0.0);
  const double frustum = (1 + s.taper + s.taper * s.taper) / 3;
  const double bar_corner = s.corner * 0.3, gap = 1 - 2 * s.bar, nose_corner = s.corner * 0.4;
  const double bar = s.width * s.bar - 2 * bar_corner * bar_corner;
  const double nose = gap * s.core - 2 * nose_corner * nose_corner;
  const double exact = 2 * bar * (s.core + (1 - s.core) * frustum) + s.width * gap * s.core +
                       4 * 0.5 * bar_corner * bar_corner * s.core + nose * (s.length - s.width) * frustum;
  CHECK(volume(accropode(1, s)) == Approx(exact).epsilon(1e-9));
}

TEST_CASE("a dolos with the Shore Protection Manual's proportions has V = 0.16 C^3 to its two digits") {
  CHECK(volume(dolos(1)) == Approx(0.16).margin(0.005));
}

TEST_CASE("a tetrapod with the Shore Protection Manual's proportions has V = 0.280 H^3 within 0.5 %") {
  const Solid unit = tetrapod(1);
  CHECK(volume(unit) == Approx(0.280).epsilon(0.005));
  const Box box = bounding_box(unit);
  CHECK(box.min.z() == Approx(-0.5).margin(1e-6));
  CHECK(box.max.z() == Approx(0.5).margin(1e-6));
}

TEST_CASE("a tetrapod has the inertia of a body with its symmetry, equal about every axis") {
  const Mat3 inertia = mass_properties(tetrapod(1.7)).inertia;
  CHECK((inertia - inertia(0, 0) * Mat3::Identity()).norm() < 1e-6 * inertia(0, 0));
}

TEST_CASE("a cubipod is a cube with six truncated pyramids, H from tip to tip") {
  const CubipodShape shape{0.7, 0.5, 0.3};
  const double rise = 0.5 * (1 - shape.cube);
  const double pyramid =
      rise / 3 * (shape.root * shape.root + shape.root * shape.tip + shape.tip * shape.tip);
  CHECK(volume(cubipod(1, shape)) == Approx(std::pow(shape.cube, 3) + 6 * pyramid).epsilon(1e-9));
  CHECK(volume(cubipod(2)) == Approx(0.544 * 8).epsilon(1e-3));
  CHECK_THROWS_WITH(cubipod(1, {0.5, 0.6, 0.3}), Catch::Contains("root"));
}

TEST_CASE("an antifer cube is a frustum less four half cylinders") {
  const AntiferShape s;
  const double frustum = (s.bottom * s.bottom + s.bottom * s.top + s.top * s.top) / 3;
  const double slant = std::hypot(1., 0.5 * (s.bottom - s.top));
  const double grooves = 4 * 0.5 * M_PI * s.groove * s.groove * slant;
  CHECK(volume(antifer(1)) == Approx(frustum - grooves).epsilon(1e-6));
  CHECK(volume(antifer(1)) == Approx(1.0247).epsilon(1e-3));
  AntiferShape plain;
  plain.groove = 0;
  CHECK(volume(antifer(1, plain)) == Approx(frustum).epsilon(1e-9));
}

TEST_CASE("a slope rises by its gradient and has half the volume of its box") {
  const Solid wedge = slope(1 / 1.5, 20, 8);
  CHECK(volume(wedge) == Approx(0.5 * 20 * 8 * 20 / 1.5).epsilon(1e-9));
  const Box box = bounding_box(wedge);
  CHECK((box.min - Vec3(0, -4, 0)).norm() == Approx(0).margin(1e-6));
  CHECK((box.max - Vec3(20, 4, 20 / 1.5)).norm() == Approx(0).margin(1e-6));
}

TEST_CASE("units of one shape are similar: height goes with the cube root of mass, inertia with mass^(5/3)") {
  const auto build = [](double height) { return accropode(height); };
  const double light = height_of_volume(5000 / 2500., build), heavy = height_of_volume(16000 / 2500., build);
  CHECK(heavy / light == Approx(std::cbrt(16. / 5)).epsilon(1e-12));
  CHECK(light == Approx(1.81).epsilon(0.005)); // 5 t at 2500 kg/m3
  CHECK(volume(build(light)) == Approx(2).epsilon(1e-9));
  CHECK(mass_properties(build(heavy)).inertia(0, 0) / mass_properties(build(light)).inertia(0, 0) ==
        Approx(std::pow(16. / 5, 5. / 3)).epsilon(1e-8));
}

TEST_CASE("proportions that make no unit are refused") {
  AccropodeShape thick;
  thick.bar = 0.6;
  CHECK_THROWS_WITH(accropode(1, thick), "bar = 0.6: must be from 0.1 to 0.45");
  DolosShape thin;
  thin.root = 0.1;
  CHECK_THROWS_AS(dolos(1, thin), InputError);
  CHECK_THROWS_WITH(tetrapod(-1), "height = -1: must be finite and > 0 m");
  CHECK_THROWS_WITH(slope(0, 1, 1), "gradient = 0: must be from 0.01 to 10");
  CHECK_THROWS_AS(cube(std::nan("")), InputError);
}
