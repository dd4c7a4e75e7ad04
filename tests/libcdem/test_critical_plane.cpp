// Faces of joints are judged by the traction on their own plane, faces of the material by the stress.
#include "libcdem/fracture/strength_watch.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace testing;
using cdem::BondMode;
using cdem::FacePlane;
using geom::Mat3;
using geom::Vec3;

namespace {

const cdem::RockStrength limits = cdem::rock_strength(concrete_joint(cdem::Softening::none));

// Axial stress at which a plane, its normal at this angle to the axis, fails when the stress goes from all-round to axial,
// into tension (sign 1) or pressure (-1): the first of its two conditions to be met; infinite: never.
double axial_strength(double angle, double lateral, double sign) {
  const double c = std::cos(angle), s = std::sin(angle), mu = std::tan(30 * degree);
  double first = sign * std::numeric_limits<double>::infinity();
  const auto met_at = [&](double x) {
    if (std::isfinite(x) && sign * (x - lateral) >= 0 && sign * x < sign * first)
      first = x;
  };
  met_at((tension - lateral * s * s) / (c * c));
  // sign (x - lateral) s c + mu (x c2 + lateral s2) = cohesion
  met_at((cohesion + sign * lateral * s * c - mu * lateral * s * s) / (sign * s * c + mu * c * c));
  return first;
}

Mat3 axial(double stress, double lateral, const Mat3& turn) {
  return turn * Vec3(lateral, lateral, stress).asDiagonal() * turn.transpose();
}

} // namespace

TEST_CASE("critical plane: a joint fails by the traction on its own plane, at every angle",
          "[cohesive][law]") {
  const double lateral = GENERATE(0.0, -5e6, -20e6), sign = GENERATE(1.0, -1.0);
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int degrees = 0; degrees <= 90; degrees += 5) {
    const double angle = degrees * degree;
    const Mat3 turn = rotation(Vec3(uniform(draw), uniform(draw), uniform(draw)), uniform(draw) * 3);
    const Vec3 normal = turn * Vec3(std::sin(angle), 0, std::cos(angle));
    const double strength = axial_strength(angle, lateral, sign);
    INFO("angle " << degrees << ", lateral " << lateral << ", sign " << sign << ", strength " << strength);
    const auto plane_at = [&](double stress) {
      return critical_plane(axial(stress, lateral, turn), limits, normal, FacePlane::own);
    };
    if (std::abs(strength) > 400e6) {
      CHECK_FALSE(plane_at(lateral + sign * 400e6));
      continue;
    }
    CHECK_FALSE(plane_at(lateral + 0.9999 * (strength - lateral)));
    const auto plane = plane_at(lateral + 1.0001 * (strength - lateral));
    REQUIRE(plane);
    CHECK((plane->normal - normal).norm() < 1e-12);
  }
}

TEST_CASE("critical plane: beyond the strength the traction is brought back to it, and that takes energy",
          "[cohesive][law]") {
  std::mt19937 draw(9);
  std::normal_distribution<double> normal;
  const double lambda = concrete().lame_lambda(), g = concrete().shear_modulus();
  int failed = 0;
  for (int i = 0; i < 4000; ++i) {
    Mat3 stress;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column <= row; ++column)
        stress(row, column) = stress(column, row) = 0.7 * cohesion * normal(draw);
    const Vec3 face = Vec3(normal(draw), normal(draw), normal(draw)).normalized();
    const FacePlane kind = i % 2 == 0 ? FacePlane::own : FacePlane::of_material;
    const auto plane = critical_plane(stress, limits, face, kind);
    CHECK((strength_utilisation(stress, limits, face, kind) >= 1 || !plane));
    if (!plane)
      continue;
    ++failed;
    const Vec3& m = plane->normal;
    const double tn = plane->traction.dot(m), ts = (plane->traction - tn * m).norm();
    CHECK(std::max(tn / tension, (ts + tn * std::tan(30 * degree)) / cohesion) == Approx(1).epsilon(1e-9));
    const Mat3 relieved = stress + cdem::relief(plane->traction - stress * m, m, lambda, g);
    CHECK((relieved * m - plane->traction).norm() < 1e-9 * stress.norm());
    const auto energy = [&](const Mat3& s) {
      const double nu = concrete().poissons_ratio;
      return s.squaredNorm() - nu / (1 + nu) * s.trace() * s.trace();
    };
    CHECK(energy(relieved) <= energy(stress) * (1 + 1e-12));
    // Below its strength the material uses more than a joint of the same strength.
    const Mat3 small = 0.25 * stress;
    const double most = strength_utilisation(small, limits);
    CHECK((most > 1 || strength_utilisation(small, limits, face, FacePlane::own) <= most * (1 + 1e-12)));
  }
  CHECK(failed > 500);
}
