// Philox 4x32-10 (library Random123): uniform() takes the first two words of a block, normal() the other two, so that the two
// never share a number. normal() inverts the normal distribution by Wichura's rational approximations (AS
// 241, 1988; relative error 1e-16).
#include "libgeom/core/random.hpp"

#include "libgeom/core/portable.hpp"

#include <Random123/philox.h>
#include <cassert>
#include <cmath>

namespace geom {
namespace {

std::array<std::uint32_t, 4> block(std::uint64_t seed, std::uint64_t id, std::uint64_t draw) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
  return philox({low(id), high(id), low(draw), high(draw)}, {low(seed), high(seed)});
}

// Integer of 53 bits.
std::uint64_t bits53(std::uint32_t low, std::uint32_t high) {
  return ((static_cast<std::uint64_t>(high) << 32) | low) >> 11;
}

constexpr double to_unit = 1.0 / 9007199254740992.0; // 2^-53

double polynomial(const std::array<double, 8>& c, double x) {
  double sum = 0;
  for (int i = 7; i >= 0; --i)
    sum = sum * x + c[i];
  return sum;
}

} // namespace

std::array<std::uint32_t, 4> philox(const std::array<std::uint32_t, 4>& counter,
                                    const std::array<std::uint32_t, 2>& key) {
  const r123::Philox4x32 generator; // of 10 rounds
  const auto words = generator({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
  return {words[0], words[1], words[2], words[3]};
}

double normal_quantile(double p) {
  assert(p > 0 && p < 1);
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q *
           polynomial({3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3,
                       1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
                       3.3430575583588128105e4, 2.5090809287301226727e3},
                      r) /
           polynomial({1.0, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3,
                       2.1213794301586595867e4, 3.9307895800092710610e4, 2.8729085735721942674e4,
                       5.2264952788528545610e3},
                      r);
  }
  const double r = std::sqrt(-portable::log(q < 0 ? p : 1 - p)); // sqrt is correctly rounded everywhere
  double tail;
  if (r <= 5)
    tail = polynomial({1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0,
                       3.64784832476320460504e0, 1.27045825245236838258e0, 2.41780725177450611770e-1,
                       2.27238449892691845833e-2, 7.74545014278341407640e-4},
                      r - 1.6) /
           polynomial({1.0, 2.05319162663775882187e0, 1.67638483018380384940e0, 6.89767334985100004550e-1,
                       1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4,
                       1.05075007164441684324e-9},
                      r - 1.6);
  else
    tail = polynomial({6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0,
                       2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                       2.71155556874348757815e-5, 2.01033439929228813265e-7},
                      r - 5) /
           polynomial({1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
                       7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
                       2.04426310338993978564e-15},
                      r - 5);
  return q < 0 ? -tail : tail;
}

double uniform(std::uint64_t seed, std::uint64_t id, std::uint64_t draw) {
  const auto x = block(seed, id, draw);
  return to_unit * static_cast<double>(bits53(x[0], x[1]));
}

double normal(std::uint64_t seed, std::uint64_t id, std::uint64_t draw) {
  const auto x = block(seed, id, draw);
  return normal_quantile(to_unit * static_cast<double>(bits53(x[2], x[3]) | 1)); // odd: never 0, never 1
}

} // namespace geom
