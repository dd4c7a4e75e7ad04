// Stress around a crack's tip as one tensor: the mean over the elements near it, weighted with
// exp(-2 (distance / radius)^2).
//
// Over a full disc about the tip of a crack in plane strain the singular fields have the mean
//   s_yy : s_xx : t_xy = 4.8 K_I : 3.2 K_I : 3.2 K_II   (x along the crack),
// so the plane normal to the largest principal tension turns by atan(4 K_II / K_I) / 2 from the crack, which
// for small K_II / K_I is the 2 K_II / K_I of the largest hoop stress (Erdogan and Sih 1963), whatever the
// weight along the radius and wherever blocks end. The mean over one block ahead of the tip depends on where
// the tip meets the block.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

struct MeanField {
  geom::Mat3 stress = geom::Mat3::Zero();   // Pa, tension positive
  geom::Mat3 gradient = geom::Mat3::Zero(); // du_i / dx_j
};

MeanField mean_field(const Model&, const State&, const geom::Vec3& centre, double radius);

} // namespace cdem
