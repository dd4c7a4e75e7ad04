// Area of the cracks of a model, and the energy that they took, by mode.
//
//   area   = sum A (broken in tension) + sum A (broken in shear) + sum D A (damaged)
//   energy = what breaking and damage took (state/crack_energy.hpp)
//
// The area is that of the faces. A cohesive crack that has to zigzag along faces takes G times its area projected on the
// planes that fail, sum (m.n) D A: energy over projected area is the fracture energy per area.
#pragma once

#include "libcdem/state/state.hpp"

#include <string>

namespace cdem {

struct Cracks {
  double tension = 0, shear = 0; // m2, broken
  double damaged = 0;            // m2, damage times area of what softens and is not broken
  double projected = 0;          // m2, of all three
  CrackEnergy energy;

  double broken() const { return tension + shear; }
  double area() const { return broken() + damaged; }
  Cracks& operator+=(const Cracks&);
};

struct CracksByBody {
  std::vector<Cracks> bodies; // (n_bodies)
  Cracks between;             // in joints between two bodies
  Cracks all() const;
};

CracksByBody cracks(const Model&, const State&);

// Sampled into a history: "area", "tension_area", "shear_area", "damaged_area", "projected_area", "energy",
// "tension_energy", "shear_energy". An assert for another name.
const std::vector<std::string>& crack_quantities();
double crack_quantity(const Cracks&, const std::string& name);

} // namespace cdem
