#include "libcdem/joint/strength_scatter.hpp"

#include "libgeom/core/portable.hpp"

#include <algorithm>

namespace cdem {
namespace {

constexpr double least_draw = 0x1p-53; // a draw of 0 would leave no strength at all

} // namespace

// Lanczos's series with g = 7 and nine terms (Numerical Recipes, 3rd ed., section 6.1): relative error 1e-15.
double gamma_function(double x) {
  constexpr double g = 7, root_of_two_pi = 2.5066282746310005;
  constexpr double c[] = {0.99999999999980993,  676.5203681218851,     -1259.1392167224028,
                          771.32342877765313,   -176.61502916214059,   12.507343278686905,
                          -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7};
  double sum = c[0];
  for (int i = 1; i < 9; ++i)
    sum += c[i] / (x - 1 + i);
  const double t = x - 0.5 + g;
  return root_of_two_pi * geom::portable::exp((x - 0.5) * geom::portable::log(t) - t) * sum;
}

double scatter_factor(const StrengthScatter& scatter, double volume, double draw) {
  const double u = std::clamp(draw, least_draw, 1 - least_draw), power = 1 / scatter.modulus;
  const double exponential = -geom::portable::log(1 - u); // mean 1
  return geom::portable::exp(power * geom::portable::log(scatter.reference_volume / volume * exponential)) /
         gamma_function(1 + power);
}

} // namespace cdem
