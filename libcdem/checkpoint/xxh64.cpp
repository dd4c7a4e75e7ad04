#include "libcdem/checkpoint/xxh64.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {
namespace {

constexpr std::uint64_t p1 = 0x9E3779B185EBCA87ull, p2 = 0xC2B2AE3D27D4EB4Full, p3 = 0x165667B19E3779F9ull,
                        p4 = 0x85EBCA77C2B2AE63ull, p5 = 0x27D4EB2F165667C5ull;

std::uint64_t rotated(std::uint64_t x, int by) {
  return (x << by) | (x >> (64 - by));
}

template <class T>
std::uint64_t read(const unsigned char* p) {
  T x;
  std::memcpy(&x, p, sizeof x);
  return x;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t input) {
  return rotated(lane + input * p2, 31) * p1;
}

} // namespace

void Xxh64::stripe(const unsigned char* p) {
  for (int i = 0; i < 4; ++i)
    lane_[i] = round(lane_[i], read<std::uint64_t>(p + 8 * i));
}

void Xxh64::add(const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  std::size_t held = length_ % 32;
  length_ += bytes;
  if (held > 0) {
    const std::size_t taken = std::min(bytes, 32 - held);
    std::copy(p, p + taken, rest_.begin() + static_cast<std::ptrdiff_t>(held));
    p += taken;
    bytes -= taken;
    held += taken;
    if (held < 32)
      return;
    stripe(rest_.data());
  }
  for (; bytes >= 32; bytes -= 32, p += 32)
    stripe(p);
  std::copy(p, p + bytes, rest_.begin());
}

std::uint64_t Xxh64::value() const {
  std::uint64_t h = p5;
  if (length_ >= 32) {
    h = rotated(lane_[0], 1) + rotated(lane_[1], 7) + rotated(lane_[2], 12) + rotated(lane_[3], 18);
    for (const std::uint64_t lane : lane_)
      h = (h ^ round(0, lane)) * p1 + p4;
  }
  h += length_;
  const unsigned char* p = rest_.data();
  std::size_t left = length_ % 32;
  for (; left >= 8; left -= 8, p += 8)
    h = rotated(h ^ round(0, read<std::uint64_t>(p)), 27) * p1 + p4;
  if (left >= 4) {
    h = rotated(h ^ (read<std::uint32_t>(p) * p1), 23) * p2 + p3;
    left -= 4;
    p += 4;
  }
  for (; left > 0; --left, ++p)
    h = rotated(h ^ (*p * p5), 11) * p1;
  h = (h ^ (h >> 33)) * p2;
  h = (h ^ (h >> 29)) * p3;
  return h ^ (h >> 32);
}

std::uint64_t xxh64(const void* data, std::size_t bytes) {
  Xxh64 sum;
  sum.add(data, bytes);
  return sum.value();
}

} // namespace cdem
