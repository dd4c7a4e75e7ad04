// XXH64, the checksum of checkpoints (Collet, xxHash specification 0.1.1): 64 bits, several bytes a cycle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cdem {

class Xxh64 {
public:
  void add(const void* data, std::size_t bytes);
  std::uint64_t value() const; // of all bytes so far, with seed 0

private:
  void stripe(const unsigned char*); // 32 bytes

  std::array<std::uint64_t, 4> lane_{0x60EA27EEADC0B5D6ull, 0xC2B2AE3D27D4EB4Full, 0, 0x61C8864E7A143579ull};
  std::array<unsigned char, 32> rest_{};
  std::uint64_t length_ = 0;
};

std::uint64_t xxh64(const void* data, std::size_t bytes);

} // namespace cdem
