// The series of exp, for one number and for several side by side (T: double or a vector of doubles).
#pragma once

namespace geom::portable {

constexpr double ln2 = 0x1.62e42fefa39efp-1;

// exp(x) / 2^k, where k is the whole number nearest to x / ln 2.
template <class T>
[[gnu::always_inline]] inline T exp_over_power(const T& x, const T& k) {
  // x = k ln 2 + r, ln 2 in two parts: k times the first is exact.
  constexpr double ln2_1 = 0x1.62e42fee00000p-1, ln2_2 = 0x1.a39ef35793c76p-33;
  constexpr double c[] = {1 / 2.,         1 / 6.,          1 / 24.,         1 / 120.,     1 / 720.,
                          1 / 5040.,      1 / 40320.,      1 / 362880.,     1 / 3628800., 1 / 39916800.,
                          1 / 479001600., 1 / 6227020800., 1 / 87178291200.};
  const T r1 = x - k * ln2_1, r2 = k * ln2_2, r = r1 - r2;
  T sum = T{} + c[12];
  for (int i = 11; i >= 0; --i)
    sum = sum * r + c[i];
  return 1.0 + (r + (((r1 - r) - r2) + r * r * sum));
}

} // namespace geom::portable
