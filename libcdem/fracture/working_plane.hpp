// Where a continuous body begins to crack: how near a stress is to the strength of the rock, and the plane it fails on.
//
//   use = max(sigma_1 / T, (sigma_1 - sigma_3)/2 / (c cos(phi) - (sigma_1 + sigma_3)/2 sin(phi)))
//
// with principal stresses, tension positive; at 1 it fails, in tension square to the axis of sigma_1, in shear on the
// planes whose normals stand 45 degrees + phi/2 off it, towards the axis of sigma_3 (Mohr-Coulomb with a tension
// cut-off). Where two principal stresses are equal the plane may turn about the third axis.
#pragma once

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/joint/joint.hpp"
#include "libgeom/core/types.hpp"

#include <optional>
#include <vector>

namespace cdem {

struct RockStrength {
  double tensile_strength = 0, cohesion = 0; // Pa
  double cos_friction = 1, sin_friction = 0;
  HoekBrown curve = {}; // where it is on, cohesion and friction are those of its tangent at the stress
};
RockStrength rock_strength(const Joint&);

// Whether a stress may use as much of the strength as u, told without its principal values: of a mean stress p and a
// deviator s, q^2 = s : s / 2, whatever the Lode angle,
//   sigma_1 <= p + 2 q / sqrt(3)
//   (sigma_1 - sigma_3)/2 + u sin(phi) (sigma_1 + sigma_3)/2 <= u sin(phi) p + q sqrt(1 + (u sin(phi))^2 / 3)
class UseBound {
public:
  UseBound(const RockStrength&, double u);
  // Pa2, > 0 where it may. s: Pa, in the order of Stress, one number each or several side by side.
  template <class T>
  T beyond(const T (&s)[6]) const {
    const T p = (s[0] + s[1] + s[2]) / 3, x = s[0] - p, y = s[1] - p, z = s[2] - p;
    return beyond(p, T(0.5 * (x * x + y * y + z * z) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
  }

private:
  template <class T>
  T beyond(const T& p, const T& q2) const {
    const T open = excess<T>(tensile_ - p, 4.0 / 3 * q2),
            slide = excess<T>(shear_ - slope_ * p, reach2_ * q2);
    return open > slide ? open : slide;
  }

  // missing: what the mean stress leaves to the deviator.
  template <class T>
  static T excess(const T& missing, const T& reach2) {
    return missing > 0 ? reach2 - missing * missing : T{} + 1;
  }
  double tensile_, shear_, slope_, reach2_;
};

// A stress that may use as much of the strength as u is beyond one of them at least.
std::vector<UseBound> use_bounds(const RockStrength&, double u);

double strength_use(const geom::Mat3& stress, const RockStrength&);

struct WorkingPlane {
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, on the side of the face's
  BondMode mode = BondMode::broken_tension;
};

// How far a face may stand off the plane that fails, as the least cosine between their normals. Where every face may crack,
// a crack finds faces within 45 degrees. Where only those of a border may, a ragged border has no others than its own.
inline constexpr double among_all_faces = 0.70710678118654752, among_a_border = 0.1;

// The plane on which a face with the unit normal `face` works from now on; none while the stress is below the strength, or
// the planes it fails on stand further off the face.
std::optional<WorkingPlane> working_plane(const geom::Mat3& stress, const RockStrength&,
                                          const geom::Vec3& face, double least_cosine = among_all_faces);

} // namespace cdem
