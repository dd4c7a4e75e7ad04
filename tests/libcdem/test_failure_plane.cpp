// Failure criteria and planes of Han 2010 eqs 13-17 as amended in docs/theory.md: numbers in, plane out.
// Principal stresses compression positive, sigma1 >= sigma2 >= sigma3.
#include "tests/libcdem/system.hpp"

#include "libcdem/fracture/failure_plane.hpp"
#include "libgeom/core/random.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using cdem::CutMode;
using geom::Mat3;
using geom::Vec3;

namespace {

// Stress (tension positive) with sigma1 along y, sigma2 along z and sigma3 along x.
Mat3 stress(double sigma1, double sigma2, double sigma3) {
  return -symmetric(sigma3, sigma1, sigma2, 0, 0, 0);
}

// Shear along `along` of planes with this normal.
Mat3 sliding(const Vec3& along, const Vec3& normal) {
  return 1e-3 * along * normal.transpose();
}

std::optional<cdem::FailurePlane> plane_of(const Mat3& s, const cdem::BlockStrength& strength,
                                           const cdem::RefineOptions& options = {},
                                           const Mat3& gradient = Mat3::Zero()) {
  return cdem::failure_plane(s, gradient, strength, options);
}

} // namespace

TEST_CASE("a block fails in shear when sigma1 reaches 2 c cos phi / (1 - sin phi) + sigma3 (1 + sin phi) / "
          "(1 - sin phi)",
          "[failure_plane]") {
  const double phi = GENERATE(0.0, 20.0, 30.0, 45.0) * degree;
  const double sigma3 = GENERATE(-0.5e6, 0.0, 3e6, 40e6);
  const cdem::BlockStrength strength{8e6, phi, 5e6};
  const double sine = std::sin(phi);
  const double limit = (2 * strength.cohesion * std::cos(phi) + sigma3 * (1 + sine)) / (1 - sine);
  CHECK_FALSE(plane_of(stress(limit * (1 - 1e-9), (limit + sigma3) / 2, sigma3), strength));
  const auto plane = plane_of(stress(limit * (1 + 1e-9), (limit + sigma3) / 2, sigma3), strength);
  REQUIRE(plane);
  CHECK(plane->mode == CutMode::shear);
  // At 45 deg - phi / 2 from sigma1, containing sigma2.
  CHECK(plane->angle_to_sigma1 == Approx(45 * degree - phi / 2).epsilon(1e-12));
  CHECK(std::abs(plane->normal.y()) == Approx(std::sin(45 * degree - phi / 2)).epsilon(1e-9));
  CHECK(std::abs(plane->normal.z()) < 1e-9);
  CHECK(plane->principal.x() == Approx(limit));
  CHECK(plane->principal.z() == Approx(sigma3).margin(1e-3));
}

TEST_CASE("the shear threshold moves the limit by as much traction on the critical plane",
          "[failure_plane]") {
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  cdem::RefineOptions options;
  options.shear_threshold = 0.7e6;
  // Traction on the plane itself: |t_s| = c0 - t_n tan(phi) - delta_tau.
  const double angle = 30 * degree, sigma1 = 26e6, sigma3 = 0.0;
  const Vec3 normal(-std::cos(angle), std::sin(angle), 0), along(std::sin(angle), std::cos(angle), 0);
  const Vec3 t = stress(sigma1, 0, sigma3) * normal;
  const double excess =
      std::abs(t.dot(along)) + t.dot(normal) * std::tan(strength.friction_angle) - strength.cohesion;
  REQUIRE(excess < 0);
  options.shear_threshold = -excess * (1 + 1e-9);
  CHECK(plane_of(stress(sigma1, 0, sigma3), strength, options));
  options.shear_threshold = -excess * (1 - 1e-9);
  CHECK_FALSE(plane_of(stress(sigma1, 0, sigma3), strength, options));
}

TEST_CASE("a block fails in tension across sigma3 when sigma3 reaches minus the tensile strength",
          "[failure_plane]") {
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  cdem::RefineOptions options;
  options.tension_threshold = GENERATE(0.0, 1e6);
  const double limit = strength.tensile_strength - options.tension_threshold;
  CHECK_FALSE(plane_of(stress(2e6, 0, -limit * (1 - 1e-9)), strength, options));
  const auto plane = plane_of(stress(2e6, 0, -limit * (1 + 1e-9)), strength, options);
  REQUIRE(plane);
  CHECK(plane->mode == CutMode::tension);
  CHECK(std::abs(plane->normal.x()) == Approx(1).epsilon(1e-12));
  CHECK(plane->angle_to_sigma1 == 0);
  // On the other side of sigma1 + 3 sigma3 = 0 the tension branch does not judge.
  CHECK_FALSE(plane_of(stress(3.01 * limit, 0, -limit * (1 + 1e-9)), {1e9, 30 * degree, 5e6}, options));
}

TEST_CASE("Griffith fails at (sigma1 - sigma3)^2 = 8 sigma_t (sigma1 + sigma3) along acos(ratio) / 2",
          "[failure_plane]") {
  const cdem::BlockStrength strength{0, 0, 5e6};
  cdem::RefineOptions options;
  options.criterion = cdem::Criterion::griffith;
  const double sigma3 = GENERATE(-2e6, 0.0, 10e6);
  // The larger root of the quadratic for sigma1; 8 sigma_t when sigma3 = 0.
  const double four_t = 4 * strength.tensile_strength;
  const double limit = sigma3 + four_t + std::sqrt(four_t * four_t + 4 * four_t * sigma3);
  CHECK_FALSE(plane_of(stress(limit * (1 - 1e-9), (limit + sigma3) / 2, sigma3), strength, options));
  const auto plane = plane_of(stress(limit * (1 + 1e-9), (limit + sigma3) / 2, sigma3), strength, options);
  REQUIRE(plane);
  const double angle = 0.5 * std::acos((limit - sigma3) / (2 * (limit + sigma3)));
  CHECK(plane->angle_to_sigma1 == Approx(angle).epsilon(1e-6));
  CHECK(std::abs(plane->normal.y()) == Approx(std::sin(angle)).epsilon(1e-6));
  if (sigma3 == 0) {
    CHECK(limit == Approx(8 * strength.tensile_strength));
    CHECK(plane->angle_to_sigma1 == Approx(30 * degree).epsilon(1e-6));
  }
}

TEST_CASE("of two conjugate planes the one is taken along which the block slides more", "[failure_plane]") {
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  const Mat3 s = stress(40e6, 5e6, 0);
  const double side = GENERATE(1.0, -1.0);
  const Vec3 along = std::cos(30 * degree) * Vec3::UnitY() + side * std::sin(30 * degree) * Vec3::UnitX();
  const Vec3 normal = std::sin(30 * degree) * Vec3::UnitY() - side * std::cos(30 * degree) * Vec3::UnitX();
  // The symmetric part of the gradient cannot tell the two planes apart: rotation can.
  const Mat3 compression = 1e-3 * symmetric(0.3, -1, 0, 0, 0, 0);
  const double sense = along.dot(compression * normal) > 0 ? 1 : -1; // the way the pressure drives it
  const auto plane = plane_of(s, strength, {}, compression + 1e-3 * sense * sliding(along, normal));
  REQUIRE(plane);
  CHECK_FALSE(plane->tie);
  CHECK(std::abs(plane->normal.dot(normal)) == Approx(1).epsilon(1e-9));
}

TEST_CASE("equally good conjugate planes: the one that turns from sigma1 towards sigma3, and tie says so",
          "[failure_plane]") {
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  const Mat3 compression = 1e-3 * symmetric(0.3, -1, 0, 0, 0, 0);
  const auto plane = plane_of(stress(40e6, 5e6, 0), strength, {}, compression);
  REQUIRE(plane);
  CHECK(plane->tie);
  // It contains cos(30) e_y + sin(30) e_x.
  CHECK(std::abs(plane->normal.dot(Vec3(std::sin(30 * degree), std::cos(30 * degree), 0))) < 1e-9);
}

TEST_CASE("the failure plane turns with the block", "[failure_plane]") {
  cdem::RefineOptions options;
  options.criterion = GENERATE(cdem::Criterion::mohr_coulomb, cdem::Criterion::griffith);
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto draw = [&](std::uint64_t k) { return 2 * geom::uniform(5, i, k) - 1; };
    const Mat3 s = 40e6 * symmetric(draw(0), draw(1), draw(2), draw(3), draw(4), draw(5));
    Mat3 gradient;
    gradient << draw(6), draw(7), draw(8), draw(9), draw(10), draw(11), draw(12), draw(13), draw(14);
    const Mat3 q = rotation({draw(15), draw(16), draw(17)}, pi * draw(18));
    const auto straight = plane_of(s, strength, options, gradient);
    const auto turned = plane_of(q * s * q.transpose(), strength, options, q * gradient * q.transpose());
    REQUIRE(straight.has_value() == turned.has_value());
    if (!straight)
      continue;
    CHECK(turned->mode == straight->mode);
    CHECK(turned->angle_to_sigma1 == Approx(straight->angle_to_sigma1).margin(1e-9));
    CHECK(std::abs(turned->normal.dot(q * straight->normal)) == Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("under uniaxial stress the failure plane's azimuth is that of the first axis at least 45 degrees "
          "off sigma1, "
          "whatever the rounding",
          "[failure_plane]") {
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto draw = [&](std::uint64_t k) { return 2 * geom::uniform(11, i, k) - 1; };
    const Vec3 axis = Vec3(draw(0), draw(1), draw(2)).normalized();
    const Mat3 rough = symmetric(draw(6), draw(7), draw(8), draw(9), draw(10), draw(11));
    const auto plane =
        plane_of(-40e6 * axis * axis.transpose() + 40 * rough, strength); // 1e-6 of it is noise
    REQUIRE(plane);
    const double limit = std::sqrt(0.5);
    const Vec3 across = std::abs(axis.x()) < limit   ? Vec3::UnitX()
                        : std::abs(axis.y()) < limit ? Vec3::UnitY()
                                                     : Vec3::UnitZ();
    CAPTURE(axis.transpose(), plane->normal.transpose());
    CHECK(std::abs(plane->normal.dot(axis.cross(across).normalized())) < 1e-4);
    CHECK(std::abs(plane->normal.dot(axis)) == Approx(std::sin(30 * degree)).epsilon(1e-4));
  }
}

TEST_CASE("under equal biaxial tension the crack stands across the first axis at least 45 degrees off sigma1",
          "[failure_plane]") {
  const cdem::BlockStrength strength{8e6, 30 * degree, 5e6};
  const double noise = GENERATE(-1.0, 1.0);
  const auto plane = plane_of(symmetric(6e6 + noise, 0, 6e6 - noise, 0, 0, 0), strength); // free along y
  REQUIRE(plane);
  CHECK(plane->mode == CutMode::tension);
  CHECK(std::abs(plane->normal.x()) == Approx(1).epsilon(1e-9));
}
