#include "libcdem/fracture/failure_plane.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"
#include "libgeom/core/portable.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double quarter_turn = 1.57079632679489661923;
constexpr double tie_tolerance = 1e-6;
// Two principal stresses this close, over sigma1 - sigma3, are equal: the rest is what a relaxation leaves.
constexpr double equal_stress = 1e-4;

geom::Vec3 pointing_forward(const geom::Vec3& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0 ? geom::Vec3(-axis) : axis;
}

// Direction of an axis that the stress leaves free to rotate about `fixed`: the first of x, y, z that makes at least 45
// degrees with `fixed`, less its part along `fixed`.
geom::Vec3 chosen_across(const geom::Vec3& fixed) {
  const double half = std::sqrt(0.5) * (1 + 1e-9);
  const geom::Vec3 axis = std::abs(fixed.x()) <= half   ? geom::Vec3::UnitX()
                          : std::abs(fixed.y()) <= half ? geom::Vec3::UnitY()
                                                        : geom::Vec3::UnitZ();
  return (axis - axis.dot(fixed) * fixed).normalized();
}

// The conjugate plane at `angle` from the sigma1 axis along which the block slides more.
void choose_conjugate(const geom::Vec3& axis1, const geom::Vec3& axis3, double angle,
                      const geom::Mat3& gradient, FailurePlane& plane) {
  plane.angle_to_sigma1 = angle;
  double slide[2];
  geom::Vec3 normal[2];
  for (int k = 0; k < 2; ++k) {
    const double side = k == 0 ? 1 : -1;
    const geom::Vec3 along = geom::portable::cos(angle) * axis1 + side * geom::portable::sin(angle) * axis3;
    normal[k] = geom::portable::sin(angle) * axis1 - side * geom::portable::cos(angle) * axis3;
    slide[k] = std::abs(along.dot(gradient * normal[k]));
  }
  plane.tie = std::abs(slide[0] - slide[1]) <= tie_tolerance * std::max(slide[0], slide[1]);
  plane.normal = plane.tie || slide[0] > slide[1] ? normal[0] : normal[1];
}

} // namespace

std::optional<FailurePlane> failure_plane(const geom::Mat3& stress, const geom::Mat3& gradient,
                                          const BlockStrength& strength, const RefineOptions& options) {
  // Eigenvalues of the compression-positive stress, ascending: sigma3, sigma2, sigma1.
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(-stress);
  const double sigma3 = solver.eigenvalues()[0], sigma1 = solver.eigenvalues()[2];
  geom::Vec3 axis3 = pointing_forward(solver.eigenvectors().col(0));
  geom::Vec3 axis1 = pointing_forward(solver.eigenvectors().col(2));
  const double equal = equal_stress * (sigma1 - sigma3), sigma2 = solver.eigenvalues()[1];
  if (sigma2 - sigma3 <= equal)
    axis3 = pointing_forward(chosen_across(axis1));
  else if (sigma1 - sigma2 <= equal)
    axis1 = pointing_forward(chosen_across(axis3));

  FailurePlane plane;
  plane.principal = solver.eigenvalues().reverse();
  if (sigma1 + 3 * sigma3 < 0) {
    if (sigma3 + strength.tensile_strength > options.tension_threshold)
      return {};
    plane.mode = CutMode::tension;
    plane.normal = axis3;
    plane.angle_to_sigma1 = 0;
    return plane;
  }
  if (options.criterion == Criterion::griffith) {
    if (sigma1 + sigma3 <= 0)
      return {};
    const double difference = sigma1 - sigma3;
    if (difference * difference / (8 * (sigma1 + sigma3)) - strength.tensile_strength <
        -options.tension_threshold)
      return {};
    plane.mode = CutMode::tension;
    choose_conjugate(axis1, axis3,
                     0.5 * geom::portable::acos(std::min(1.0, difference / (2 * (sigma1 + sigma3)))),
                     gradient, plane);
    return plane;
  }
  const double phi = strength.friction_angle;
  const double excess =
      mohr_coulomb(sigma1, sigma3, strength.cohesion, geom::portable::cos(phi), geom::portable::tan(phi));
  if (excess < -options.shear_threshold)
    return {};
  plane.mode = CutMode::shear;
  choose_conjugate(axis1, axis3, 0.5 * (quarter_turn - phi), gradient, plane);
  return plane;
}

} // namespace cdem
