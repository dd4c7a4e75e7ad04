// One node's vector as the hot loops keep it.
#pragma once

#define CDEM_INLINE inline __attribute__((always_inline))

namespace cdem {

inline constexpr int lanes = 8; // tets side by side in a batch

// Half a cache line; w is free for the array's owner.
struct alignas(32) Node {
  double x = 0, y = 0, z = 0, w = 0;
};

} // namespace cdem
