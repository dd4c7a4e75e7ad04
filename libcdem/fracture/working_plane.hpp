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

namespace cdem {

struct RockStrength {
  double tensile_strength = 0, cohesion = 0; // Pa
  double cos_friction = 1, sin_friction = 0;

  // Pa: a stress whose norm sqrt(s : s) is below uses less than 1 of the strength.
  double least_norm() const;
};
RockStrength rock_strength(const Joint&);

double strength_use(const geom::Mat3& stress, const RockStrength&);

struct WorkingPlane {
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, on the side of the face's
  BondMode mode = BondMode::broken_tension;
};

// The plane on which a face with the unit normal `face` works from now on; none while the stress is below the strength, or
// the planes it fails on stand more than 45 degrees off the face.
std::optional<WorkingPlane> working_plane(const geom::Mat3& stress, const RockStrength&,
                                          const geom::Vec3& face);

} // namespace cdem
