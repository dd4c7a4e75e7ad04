// Strength that scatters from face to face (Weibull 1951, J. Appl. Mech. 18). A volume V under uniform tension bears
// the stress s with the probability
//
//   exp(-V / V_ref (Gamma(1 + 1/m) s / T)^m),   mean T (V_ref / V)^(1/m)
//
// T: the mean strength of the reference volume, which the joint gives. A face draws for the volume that belongs to it,
// so that the weakest of the faces of a body has the strength of the body's volume whatever the mesh:
//
//   factor = (V_ref / V)^(1/m) (-ln(1 - u))^(1/m) / Gamma(1 + 1/m),   u uniform in (0, 1)
#pragma once

#include <cstdint>

namespace cdem {

struct StrengthScatter {
  double modulus = 0;          // m, the Weibull modulus; 0: no scatter
  double reference_volume = 0; // V_ref, m3
  std::uint64_t seed = 0;

  bool on() const { return modulus > 0; }
};

// Factor on the strength of the joint. volume: m3, > 0; draw: u.
double scatter_factor(const StrengthScatter&, double volume, double draw);

double gamma_function(double x); // x in [1, 2], the same bits on every processor

} // namespace cdem
