// Sums of doubles that do not depend on their order: every bit is kept, and rounded once at the end (a long accumulator
// after U. Kulisch). So sums of parts, made anywhere, are added as whole numbers, and what comes out has the same bits
// for every number of ranks.
//
// A double is a whole number times 2^-1074. The accumulator is such a number too, in digits of 32 bits. Each stands in 64
// bits with a sign, so that 2^30 doubles may be added before a carry is due.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace cdem {

// The digits of one sum.
struct ExactDigits {
  static constexpr std::uint64_t digit = 0xffffffff;
  // One for what is no number, two that stay zero, 2098 bits of doubles, and room for 2^60 of the largest.
  static constexpr std::size_t not_numbers = 0, first = 3, count = first + 66 + 3;
  static constexpr std::size_t of_a_double = 3;

  // Returns the first of the digits that it has changed.
  static std::size_t add(std::int64_t* digits, double x) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    const auto exponent = static_cast<std::uint32_t>(bits >> 52 & 0x7ff);
    std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52) - 1);
    if (exponent == 0x7ff) {
      ++digits[not_numbers];
      return first;
    }
    if (exponent > 0)
      mantissa |= std::uint64_t{1} << 52;
    const std::uint32_t place = exponent > 0 ? exponent - 1 : 0; // of its last bit
    const std::uint64_t low = (mantissa & digit) << place % 32, high = (mantissa >> 32) << place % 32;
    const std::int64_t parts[of_a_double] = {static_cast<std::int64_t>(low & digit),
                                             static_cast<std::int64_t>((low >> 32) + (high & digit)),
                                             static_cast<std::int64_t>(high >> 32)};
    const std::size_t begin = first + place / 32;
    for (std::size_t i = 0; i < of_a_double; ++i)
      digits[begin + i] += bits >> 63 != 0 ? -parts[i] : parts[i];
    return begin;
  }

  // The double nearest to the sum, the even one of two; NaN where something was no finite number. All digits outside
  // [begin, end) are zero.
  static double value(const std::int64_t* digits, std::size_t begin = first, std::size_t end = count) {
    if (digits[not_numbers] != 0)
      return std::numeric_limits<double>::quiet_NaN();
    if (begin >= end)
      return 0;
    const std::size_t stop = std::min(end + 3, count); // with room for what is carried
    std::array<std::int64_t, count> d;
    std::copy(digits + begin - 2, digits + stop, d.data() + begin - 2);
    const bool negative = carry(d, begin, stop) < 0;
    if (negative) {
      for (std::size_t i = begin; i < stop; ++i)
        d[i] = -d[i];
      carry(d, begin, stop);
    }
    std::size_t top = stop - 1;
    while (top > begin && d[top] == 0)
      --top;
    if (d[top] == 0)
      return 0;
    const auto at = [&](std::size_t i) { return static_cast<std::uint64_t>(d[i]); };
    const int lead = 64 - __builtin_clzll(at(top)); // bits of its first digit
    // The first 64 bits, and whether any is set behind them.
    std::uint64_t bits = (at(top) << 32 | at(top - 1)) << (32 - lead) | at(top - 2) >> lead;
    bool more = (at(top - 2) & ((std::uint64_t{1} << lead) - 1)) != 0;
    for (std::size_t i = begin; i + 2 < top; ++i)
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

private:
  // Leaves digits of 32 bits; returns what goes out at the top, below zero of a negative sum.
  static std::int64_t carry(std::array<std::int64_t, count>& d, std::size_t begin, std::size_t stop) {
    std::int64_t over = 0;
    for (std::size_t i = begin; i < stop; ++i) {
      const std::int64_t sum = d[i] + over;
      over = sum >> 32;
      d[i] = sum & static_cast<std::int64_t>(digit);
    }
    return over;
  }
};

// Several sums, all digits of which ranks add in one message.
template <std::size_t n>
class ExactSums {
public:
  void add(std::size_t sum, double x) { ExactDigits::add(&digits_[sum * ExactDigits::count], x); }
  double value(std::size_t sum) const { return ExactDigits::value(&digits_[sum * ExactDigits::count]); }

  // All digits: those of two parts are added one by one.
  std::int64_t* data() { return digits_.data(); }
  static constexpr std::size_t size() { return n * ExactDigits::count; }

private:
  std::array<std::int64_t, size()> digits_{};
};

// One sum, of which only the digits that were touched are cleared, read and told: some five where all that is added is of
// about one size.
class ExactSum {
public:
  void add(double x) {
    if (x == 0)
      return;
    const std::size_t at = ExactDigits::add(digits_.data(), x);
    begin_ = std::min(begin_, static_cast<std::uint8_t>(at));
    end_ = std::max(end_, static_cast<std::uint8_t>(at + ExactDigits::of_a_double));
  }
  double value() const { return ExactDigits::value(digits_.data(), begin_, end_); }
  void clear() {
    digits_[ExactDigits::not_numbers] = 0;
    if (begin_ < end_)
      std::fill(digits_.begin() + begin_, digits_.begin() + end_, 0);
    begin_ = ExactDigits::count;
    end_ = 0;
  }

  // Writes and reads by bytes(address, count), as Pack and Unpack (ranks/bytes.hpp).
  template <class Bytes>
  void tell(Bytes& to) const {
    const std::uint8_t head[3] = {begin_, end_, digits_[ExactDigits::not_numbers] != 0};
    to.bytes(head, sizeof head);
    if (begin_ < end_)
      to.bytes(&digits_[begin_], (end_ - begin_) * sizeof(std::int64_t));
  }
  template <class Bytes>
  void add_told(Bytes& from) {
    std::uint8_t head[3];
    from.bytes(reinterpret_cast<char*>(head), sizeof head);
    digits_[ExactDigits::not_numbers] += head[2];
    for (std::size_t i = head[0]; i < head[1]; ++i) {
      std::int64_t more = 0;
      from.bytes(reinterpret_cast<char*>(&more), sizeof more);
      digits_[i] += more;
    }
    begin_ = std::min(begin_, head[0]);
    end_ = std::max(end_, head[1]);
  }

private:
  std::array<std::int64_t, ExactDigits::count> digits_{};
  std::uint8_t begin_ = ExactDigits::count, end_ = 0; // of those that are not zero
};

} // namespace cdem
