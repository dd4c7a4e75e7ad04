#include "libcdem/fracture/working_plane.hpp"

#include "libcdem/joint/mohr_coulomb.hpp"
#include "libgeom/core/portable.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

using geom::Vec3;

// Principal stresses nearer than this part of sigma_1 - sigma_3 count as equal.
constexpr double nearly_equal = 0.02;

struct Uses {
  double tension = 0, shear = 0;
};

RockStrength at_pressure(RockStrength rock, double p3) {
  if (rock.curve.on()) {
    const StraightStrength line = tangent(rock.curve, p3);
    rock.cohesion = line.cohesion;
    rock.cos_friction = line.cos_friction;
    rock.sin_friction = line.sin_friction;
  }
  return rock;
}

// Principal stresses, ascending; the strength at their pressure.
Uses uses(const Vec3& s, const RockStrength& rock) {
  return {s[2] / rock.tensile_strength,
          mohr_coulomb_use(-s[0], -s[2], rock.cohesion, rock.cos_friction, rock.sin_friction)};
}

// What of v lies in the plane of two axes, as a unit vector; the first axis where that is nothing.
Vec3 nearest_in(const Vec3& first, const Vec3& second, const Vec3& v) {
  const Vec3 in = v.dot(first) * first + v.dot(second) * second;
  return in.norm() > 1e-9 ? Vec3(in.normalized()) : first;
}

} // namespace

RockStrength rock_strength(const Joint& joint) {
  return {joint.tensile_strength, joint.cohesion, geom::portable::cos(joint.friction_angle),
          geom::portable::sin(joint.friction_angle), joint.curve};
}

UseBound::UseBound(const RockStrength& rock, double u)
    : tensile_(u * rock.tensile_strength), shear_(u * rock.cohesion * rock.cos_friction),
      slope_(u * rock.sin_friction), reach2_(1 + slope_ * slope_ / 3) {}

std::vector<UseBound> use_bounds(const RockStrength& rock, double u) {
  if (!rock.curve.on())
    return {UseBound(rock, u)};
  std::vector<UseBound> bounds;
  for (const StraightStrength& chord : chords(rock.curve))
    bounds.emplace_back(
        RockStrength{rock.tensile_strength, chord.cohesion, chord.cos_friction, chord.sin_friction, {}}, u);
  return bounds;
}

double strength_use(const geom::Mat3& stress, const RockStrength& rock) {
  const Vec3 s = Eigen::SelfAdjointEigenSolver<geom::Mat3>(stress, Eigen::EigenvaluesOnly).eigenvalues();
  const Uses u = uses(s, at_pressure(rock, -s[2]));
  return std::max(u.tension, u.shear);
}

std::optional<WorkingPlane> working_plane(const geom::Mat3& stress, const RockStrength& given,
                                          const geom::Vec3& face, double least_cosine) {
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(stress);
  const Vec3& s = solver.eigenvalues();
  const RockStrength rock = at_pressure(given, -s[2]);
  const Uses u = uses(s, rock);
  if (!(std::max(u.tension, u.shear) >= 1))
    return std::nullopt;
  const Vec3 axis3 = solver.eigenvectors().col(0), axis2 = solver.eigenvectors().col(1),
             axis1 = solver.eigenvectors().col(2);
  const double equal = nearly_equal * (s[2] - s[0]);
  const Vec3 free1 = s[2] - s[1] <= equal ? nearest_in(axis1, axis2, face) : axis1;
  WorkingPlane plane;
  if (u.tension >= u.shear) {
    plane.normal = free1;
    if (s[2] - s[0] <= nearly_equal * std::abs(s[2])) // all-round
      plane.normal = face;
  } else {
    plane.mode = BondMode::broken_shear;
    const Vec3 free3 = s[1] - s[0] <= equal ? nearest_in(axis3, axis2, face) : axis3;
    // cos and sin of 45 degrees + phi/2.
    const double cosine = std::sqrt(0.5 * (1 - rock.sin_friction)),
                 sine = std::sqrt(0.5 * (1 + rock.sin_friction));
    for (const double side : {1.0, -1.0})
      if (const Vec3 normal = cosine * free3 + side * sine * free1;
          std::abs(normal.dot(face)) > std::abs(plane.normal.dot(face)))
        plane.normal = normal;
  }
  const double along = plane.normal.dot(face);
  if (std::abs(along) < least_cosine)
    return std::nullopt;
  if (along < 0)
    plane.normal = -plane.normal;
  return plane;
}

} // namespace cdem
