// Stress present before anything moves: uniform, or growing with depth below a surface (in-situ stress of rock),
//
//   sigma_zz = -g d,   sigma_xx = kx sigma_zz,   sigma_yy = ky sigma_zz,   d = max(0, surface - z)
//
// with g the weight per volume and kx, ky the ratios of horizontal to vertical stress (K0). Each tetrahedron takes the
// stress at its centroid, which with linear shape functions gives the exact nodal forces of a stress that is linear in z.
// Interfaces between selected blocks start with the traction of the field at their points.
#pragma once

#include "libcdem/model/selection.hpp"
#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

struct InitialStress {
  Selection on;
  Stress stress{};                 // Pa, the same everywhere; tension positive
  double gradient = 0;             // g, Pa/m, >= 0
  std::array<double, 2> k0{1, 1};  // along x and y, >= 0
  std::optional<double> surface{}; // m, z where the depth is 0; the top of the model
};

// Points of interfaces that the stress loads beyond what their joints bear: they break or slide in the first step.
struct BeyondStrength {
  std::int64_t points = 0;
  double largest_utilisation = 0;        // traction over strength, of all points; infinite without strength
  geom::Vec3 place = geom::Vec3::Zero(); // m, of the largest utilisation
};

Stress stress_at(const InitialStress&, double top, const geom::Vec3& place);

// Adds the stress; throws geom::InputError.
void add_initial_stress(const Model&, State&, const InitialStress&);

BeyondStrength beyond_strength(const Model&, const State&);

} // namespace cdem
