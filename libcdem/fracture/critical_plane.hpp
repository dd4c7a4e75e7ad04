// Where a continuous body begins to crack: how much of its strength a face uses under a stress, and the plane it works on
// once it fails. There are two kinds of faces.
//
// A face of the material fails where the stress says, whatever its own direction:
//   utilisation = max(sigma_1 / T, (sigma_1 - sigma_3)/2 / (c cos(phi) - (sigma_1 + sigma_3)/2 sin(phi)))
// with principal stresses, tension positive; at 1 it fails, in tension square to the axis of sigma_1, in shear on the
// planes whose normals stand 45 degrees + phi/2 off it, towards the axis of sigma_3 (Mohr-Coulomb with a tension
// cut-off). Where two principal stresses are equal the plane may turn about the third axis.
//
// A joint (a border between regions of a mesh) has a plane of its own, with the normal n. The traction t = sigma n decides:
//   utilisation = max(t_n / T, |t_s| / (c - t_n tan(phi)))
// With a Hoek-Brown strength (joint/hoek_brown.hpp) c and phi are those of its tangent: at p3 = -sigma_1 for the material, at
// the pressure -t_n for a joint.
// At the same strength it is never above the utilisation of the material as long as that is below 1: a plane sees at most
// what the worst one sees.
#pragma once

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/joint/joint.hpp"
#include "libcdem/parallel/node.hpp"
#include "libgeom/core/types.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace cdem {

struct RockStrength {
  double tensile_strength = 0, cohesion = 0; // Pa
  double cos_friction = 1, sin_friction = 0;
  HoekBrown curve = {}; // where it is on, in place of cohesion and friction
};
RockStrength rock_strength(const Joint&);

// Which plane a face is judged on. A ragged border, on which the crack follows the stress, has no other faces than its own,
// however they stand.
enum class FacePlane : std::uint8_t { of_material, of_ragged_border, own };

// Whether a stress may use as much of the strength as u, told without its principal values, for one stress or for several
// side by side. With a mean stress p, a deviator s, q^2 = s : s / 2 and J3 = det(s), the largest principal deviator is the
// largest root of x^3 - q^2 x - J3. Newton's method comes down to it from 2 q / sqrt(3), so that each of its values is an
// upper bound; with -J3 the same holds for the least one.
class UtilisationBound {
public:
  UtilisationBound(const RockStrength&, double u);
  // The same from the start of Newton's method, in Pa2, without a root or a quotient: a first, coarse answer.
  template <class T>
  CDEM_INLINE T coarsely_beyond(const T (&s)[6]) const {
    const T p = (s[0] + s[1] + s[2]) / 3, x = s[0] - p, y = s[1] - p, z = s[2] - p;
    const T q2 = 0.5 * (x * x + y * y + z * z) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    const T open = excess<T>(tensile_ - p, 4.0 / 3 * q2),
            slide = excess<T>(shear_ - slope_ * p, (1 + slope_ * slope_ / 3) * q2);
    return open > slide ? open : slide;
  }
  // Pa, > 0 where it may. s: Pa, in the order of Stress.
  template <class T>
  CDEM_INLINE T beyond(const T (&s)[6]) const {
    const T p = (s[0] + s[1] + s[2]) / 3, x = s[0] - p, y = s[1] - p, z = s[2] - p;
    const T q2 = 0.5 * (x * x + y * y + z * z) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5] + least_;
    const T j3 =
        x * (y * z - s[4] * s[4]) - s[3] * (s[3] * z - s[4] * s[5]) + s[5] * (s[3] * s[4] - y * s[5]);
    const T q = 2 * root(T(q2 / 3));
    const T first = p + largest(q, q2, j3), third = p - largest(q, q2, T(-j3));
    const T open = first - tensile_, slide = 0.5 * ((1 + slope_) * first - (1 - slope_) * third) - shear_;
    return open > slide ? open : slide;
  }

private:
  // missing: what the mean stress leaves to the deviator.
  template <class T>
  CDEM_INLINE static T excess(const T& missing, const T& reach2) {
    return missing > 0 ? reach2 - missing * missing : T{} + 1;
  }
  template <class T>
  CDEM_INLINE static T largest(const T& from, const T& q2, const T& j3) {
    constexpr int iterations = 8; // fewer leave most faces of a body under pressure beyond the bound
    T x = from;
    for (int i = 0; i < iterations; ++i)
      x = (2 * x * x * x + j3) / (3 * x * x - q2);
    return x * (1 + 1e-9); // for rounding
  }
  static double root(double x) { return std::sqrt(x); }
  template <class T>
  CDEM_INLINE static T root(T x) {
    for (std::size_t i = 0; i < sizeof x / sizeof(double); ++i)
      x[i] = std::sqrt(x[i]);
    return x;
  }
  double tensile_, shear_, slope_;
  double least_; // Pa2, next to nothing: keeps quotients finite
};

// A stress that may use as much of the strength as u is beyond one of them at least. u: at most 1.
std::vector<UtilisationBound> utilisation_bounds(const RockStrength&, double u);

// face: unit normal, on either side; what a face of the material uses does not depend on it.
double strength_utilisation(const geom::Mat3& stress, const RockStrength&,
                            const geom::Vec3& face = geom::Vec3::Zero(), FacePlane = FacePlane::of_material);

struct CriticalPlane {
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, on the side of the face's
  BondMode mode = BondMode::broken_tension;
  // Pa, on the plane, brought back to the strength where the stress is beyond it: along the ray from the origin where the
  // plane is pulled, at constant pressure where it is pressed.
  geom::Vec3 traction = geom::Vec3::Zero();
};

// How far a face of the material may stand off the plane that fails, as the least cosine between their normals. A crack mostly
// finds faces within 45 degrees; meshes of boxes have faces at just 45 degrees, which rounding must not decide about. Where a
// tet has no such face, its nearest one cracks (begin_cracks.cpp), within the limit of a ragged border.
inline constexpr double least_cosine = 0.7, least_cosine_of_ragged_border = 0.1;

// The plane on which a face with the unit normal `face` works from now on; none while the stress is below the strength, or
// the planes it fails on stand further off a face of the material.
std::optional<CriticalPlane> critical_plane(const geom::Mat3& stress, const RockStrength&,
                                            const geom::Vec3& face, FacePlane = FacePlane::of_material);

// The nearest stress with this traction on the plane with the normal n.
geom::Mat3 with_traction(const geom::Mat3& stress, const geom::Vec3& n, const geom::Vec3& traction);

// Stress by which an opening and a slip on the plane with the normal m relieve an elastic material (lambda, g: Lame's, Pa)
// when they change the traction on it by `change`: to be added. It takes energy as long as no part of the traction
// grows.
geom::Mat3 relief(const geom::Vec3& change, const geom::Vec3& m, double lambda, double g);

} // namespace cdem
