// Sums of doubles that do not depend on their order: every bit is kept, and rounded once at the end (a long accumulator
// after U. Kulisch). So sums of parts, made anywhere, are added as whole numbers, and what comes out has the same bits
// for every number of ranks.
//
// A double is a whole number times 2^-1074. The accumulator is such a number too, in digits of 32 bits. Each stands in 64
// bits with a sign, so that 2^30 doubles may be added before a carry is due.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace cdem {

template <std::size_t n>
class ExactSums {
public:
  void add(std::size_t sum, double x) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    const auto exponent = static_cast<std::uint32_t>(bits >> 52 & 0x7ff);
    std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52) - 1);
    std::int64_t* const digits = &digits_[sum * n_digits];
    if (exponent == 0x7ff) {
      ++digits[not_numbers];
      return;
    }
    if (exponent > 0)
      mantissa |= std::uint64_t{1} << 52;
    const std::uint32_t place = exponent > 0 ? exponent - 1 : 0; // of its last bit
    const std::uint64_t low = (mantissa & digit) << place % 32, high = (mantissa >> 32) << place % 32;
    const std::int64_t parts[3] = {static_cast<std::int64_t>(low & digit),
                                   static_cast<std::int64_t>((low >> 32) + (high & digit)),
                                   static_cast<std::int64_t>(high >> 32)};
    std::int64_t* const at = digits + first + place / 32;
    for (int i = 0; i < 3; ++i)
      at[i] += bits >> 63 != 0 ? -parts[i] : parts[i];
  }

  // The double nearest to the sum, the even one of two; NaN where something was no finite number.
  double value(std::size_t sum) const {
    std::array<std::int64_t, n_digits> d;
    std::memcpy(d.data(), &digits_[sum * n_digits], sizeof d);
    if (d[not_numbers] != 0)
      return std::numeric_limits<double>::quiet_NaN();
    const bool negative = carry(d) < 0;
    if (negative) {
      for (std::int64_t& one : d)
        one = -one;
      carry(d);
    }
    std::size_t top = n_digits - 1;
    while (top > first && d[top] == 0)
      --top;
    if (d[top] == 0)
      return 0;
    const auto at = [&](std::size_t i) { return static_cast<std::uint64_t>(d[i]); };
    const int lead = 64 - __builtin_clzll(at(top)); // bits of its first digit
    // The first 64 bits, and whether any is set behind them.
    std::uint64_t bits = (at(top) << 32 | at(top - 1)) << (32 - lead) | at(top - 2) >> lead;
    bool more = (at(top - 2) & ((std::uint64_t{1} << lead) - 1)) != 0;
    for (std::size_t i = first; i + 2 < top; ++i)
      more = more || d[i] != 0;
    constexpr std::uint64_t half = 0x400, rest = 0x7ff;
    const std::uint64_t behind = bits & rest;
    bits >>= 11;
    if (behind > half || (behind == half && (more || (bits & 1) != 0)))
      ++bits;
    const double size =
        std::ldexp(static_cast<double>(bits), static_cast<int>(32 * (top - first)) + lead - 64 + 11 - 1074);
    return negative ? -size : size;
  }

  // All digits: those of two parts are added one by one.
  std::int64_t* data() { return digits_.data(); }
  static constexpr std::size_t size() { return n * n_digits; }

private:
  static constexpr std::uint64_t digit = 0xffffffff;
  // One for what is no number, two that stay zero, 2098 bits of doubles, and room for 2^60 of the largest.
  static constexpr std::size_t not_numbers = 0, first = 3, n_digits = first + 66 + 3;

  // Leaves digits of 32 bits; returns what goes out at the top, below zero of a negative sum.
  static std::int64_t carry(std::array<std::int64_t, n_digits>& d) {
    std::int64_t over = 0;
    for (std::size_t i = first; i < n_digits; ++i) {
      const std::int64_t sum = d[i] + over;
      over = sum >> 32;
      d[i] = sum & static_cast<std::int64_t>(digit);
    }
    return over;
  }

  std::array<std::int64_t, n * n_digits> digits_{};
};

} // namespace cdem
