#include "libcdem/fracture/critical_plane.hpp"

#include "libcdem/fracture/crack_faces.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"
#include "libgeom/core/portable.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {
namespace {

using geom::Mat3;
using geom::Vec3;

// Principal stresses nearer than this part of sigma_1 - sigma_3 count as equal.
constexpr double nearly_equal = 0.02;

struct Utilisations {
  double tension = 0, shear = 0;
};

RockStrength with_line(RockStrength rock, const StraightStrength& line) {
  rock.cohesion = line.cohesion;
  rock.cos_friction = line.cos_friction;
  rock.sin_friction = line.sin_friction;
  return rock;
}

// p3, pressure on a plane: Pa.
RockStrength at_pressure(const RockStrength& rock, double p3) {
  return rock.curve.on() ? with_line(rock, tangent(rock.curve, p3)) : rock;
}
RockStrength at_plane_pressure(const RockStrength& rock, double pressure) {
  return rock.curve.on() ? with_line(rock, tangent_on_plane(rock.curve, pressure)) : rock;
}

// Principal stresses, ascending; the strength at their pressure.
Utilisations utilisations(const Vec3& s, const RockStrength& rock) {
  return {s[2] / rock.tensile_strength,
          mohr_coulomb_utilisation(-s[0], -s[2], rock.cohesion, rock.cos_friction, rock.sin_friction)};
}

// Whether the strength was reached in tension first, on the way from no stress. Both at once, as in uniaxial tension at the
// end of a Hoek-Brown curve, counts as tension, whatever the rounding.
bool tension_comes_first(const Vec3& s, const RockStrength& rock) {
  const double shear = 0.5 * (s[2] - s[0]) + 0.5 * (s[2] + s[0]) * rock.sin_friction;
  return s[2] / rock.tensile_strength * (1 + 1e-9) >= shear / (rock.cohesion * rock.cos_friction);
}

struct TractionParts {
  double normal = 0, shear = 0; // Pa
  Vec3 along = Vec3::Zero();    // of the shear, unit
};

TractionParts traction_on(const Mat3& stress, const Vec3& m) {
  const Vec3 t = stress * m;
  TractionParts parts;
  parts.normal = t.dot(m);
  const Vec3 shear = t - parts.normal * m;
  parts.shear = shear.norm();
  if (parts.shear > 0)
    parts.along = shear / parts.shear;
  return parts;
}

SpringStrength plane_strength(const RockStrength& rock) {
  return {rock.cohesion, rock.sin_friction / rock.cos_friction, rock.tensile_strength};
}

double utilisation_of(const TractionParts& t, const RockStrength& rock) {
  const SpringStrength s = plane_strength(rock);
  const double most = shear_strength(s.cohesion, s.tan_friction, t.normal);
  const double shear = t.shear <= 0 ? 0 : most > 0 ? t.shear / most : std::numeric_limits<double>::infinity();
  return std::max(t.normal / s.tensile_strength, shear);
}

LoadRatio ratio_of(const TractionParts& t, const RockStrength& rock) {
  return load_ratio(plane_strength(rock), t.normal, t.shear);
}

Vec3 on_strength(const TractionParts& t, const Vec3& m, const RockStrength& given) {
  const RockStrength rock = at_plane_pressure(given, -t.normal);
  if (t.normal >= 0) {
    const double ratio = std::max(1.0, ratio_of(t, rock).value);
    return (t.normal * m + t.shear * t.along) / ratio;
  }
  const SpringStrength s = plane_strength(rock);
  return t.normal * m + std::min(t.shear, shear_strength(s.cohesion, s.tan_friction, t.normal)) * t.along;
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

UtilisationBound::UtilisationBound(const RockStrength& rock, double u)
    : tensile_(u * rock.tensile_strength), shear_(u * rock.cohesion * rock.cos_friction),
      slope_(u * rock.sin_friction), least_(1e-24 * (tensile_ * tensile_ + shear_ * shear_)) {}

std::vector<UtilisationBound> utilisation_bounds(const RockStrength& rock, double u) {
  if (!rock.curve.on())
    return {UtilisationBound(rock, u)};
  std::vector<UtilisationBound> bounds;
  for (const StraightStrength& chord : chords(rock.curve))
    bounds.emplace_back(with_line(rock, chord), u);
  return bounds;
}

double strength_utilisation(const Mat3& stress, const RockStrength& rock, const Vec3& face, FacePlane kind) {
  if (kind == FacePlane::own) {
    const TractionParts t = traction_on(stress, face);
    return utilisation_of(t, at_plane_pressure(rock, -t.normal));
  }
  const Vec3 s = Eigen::SelfAdjointEigenSolver<Mat3>(stress, Eigen::EigenvaluesOnly).eigenvalues();
  const Utilisations u = utilisations(s, at_pressure(rock, -s[2]));
  return std::max(u.tension, u.shear);
}

std::optional<CriticalPlane> critical_plane(const Mat3& stress, const RockStrength& given, const Vec3& face,
                                            FacePlane kind) {
  if (kind == FacePlane::own) {
    const TractionParts t = traction_on(stress, face);
    const RockStrength rock = at_plane_pressure(given, -t.normal);
    if (!(utilisation_of(t, rock) >= 1))
      return std::nullopt;
    return CriticalPlane{face, ratio_of(t, rock).mode, on_strength(t, face, rock)};
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(stress);
  const Vec3& s = solver.eigenvalues();
  const RockStrength rock = at_pressure(given, -s[2]);
  const Utilisations u = utilisations(s, rock);
  if (!(std::max(u.tension, u.shear) >= 1))
    return std::nullopt;
  const Vec3 axis3 = solver.eigenvectors().col(0), axis2 = solver.eigenvectors().col(1),
             axis1 = solver.eigenvectors().col(2);
  const double equal = nearly_equal * (s[2] - s[0]);
  const Vec3 free1 = s[2] - s[1] <= equal ? nearest_in(axis1, axis2, face) : axis1;
  CriticalPlane plane;
  if (tension_comes_first(s, rock)) {
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
  if (std::abs(along) < (kind == FacePlane::of_ragged_border ? least_cosine_of_ragged_border : least_cosine))
    return std::nullopt;
  if (along < 0)
    plane.normal = -plane.normal;
  plane.traction = on_strength(traction_on(stress, plane.normal), plane.normal, rock);
  return plane;
}

Mat3 with_traction(const Mat3& stress, const Vec3& n, const Vec3& traction) {
  const Vec3 change = traction - stress * n, half = change - 0.5 * change.dot(n) * n;
  return stress + half * n.transpose() + n * half.transpose();
}

Mat3 relief(const Vec3& change, const Vec3& m, double lambda, double g) {
  const double normal = change.dot(m);
  const Vec3 w = (change - normal * m) / g + normal / (lambda + 2 * g) * m; // of the opposite sign
  return lambda * w.dot(m) * Mat3::Identity() + g * (w * m.transpose() + m * w.transpose());
}

} // namespace cdem
