// Energy that breaking and softening have taken, by mode: J of a body, or of the joints between bodies.
//
// The energy of a brittle bond belongs to the mode in which the bond breaks. The energy of a softening bond is divided
// in each step in the ratio of its stored energies (joint/softening.hpp, shear_share).
#pragma once

namespace cdem {

struct CrackEnergy {
  double tension = 0, shear = 0; // J

  void add(double energy, double shear_share) {
    shear += shear_share * energy;
    tension += (1 - shear_share) * energy;
  }
  CrackEnergy& operator+=(const CrackEnergy& other) {
    tension += other.tension;
    shear += other.shear;
    return *this;
  }
};

} // namespace cdem
