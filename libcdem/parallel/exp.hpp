// exp with the bits of geom::portable::exp, for one number and for several side by side.
#pragma once

#include "libcdem/parallel/simd.hpp"
#include "libgeom/core/exp_series.hpp"
#include "libgeom/core/portable.hpp"

#include <cstring>
#include <type_traits>

namespace cdem {

// Vectors: of numbers between -700 and 700.
template <class T>
CDEM_INLINE T exp_of(const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    return geom::portable::exp(x);
  } else {
    // Where this number is added, the last bits of the sum are those of the nearest whole number.
    constexpr double rounds = 0x1.8p52;
    using Bits = simd::MaskOf<T>;
    const T sum = x / geom::portable::ln2 + rounds;
    Bits bits;
    std::memcpy(&bits, &sum, sizeof bits);
    bits = (bits << 52) + (std::int64_t{1023} << 52);
    T power;
    std::memcpy(&power, &bits, sizeof power);
    return geom::portable::exp_over_power<T>(x, sum - rounds) * power;
  }
}

} // namespace cdem
