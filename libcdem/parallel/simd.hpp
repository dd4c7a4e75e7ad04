// Eight tets side by side: vectors of eight doubles and the transposes between node records and components.
// Plain compiler vectors: each kernel is compiled for several instruction sets (parallel/instruction_set.hpp); with none
// of them they fall back to pairs.
#pragma once

#include "libcdem/parallel/instruction_set.hpp"
#include "libcdem/parallel/node.hpp"

#include <cstring>

namespace cdem {

namespace simd {

using Quad = double __attribute__((vector_size(32)));
using Oct = double __attribute__((vector_size(64)));
using Mask = decltype(Oct{} < Oct{});

CDEM_INLINE Quad load(const Node& n) {
  Quad q;
  std::memcpy(&q, &n.x, sizeof q);
  return q;
}

CDEM_INLINE void store(Node& n, const Quad& q) {
  std::memcpy(&n.x, &q, sizeof q);
}

CDEM_INLINE Oct load(const double (&p)[lanes]) {
  Oct v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

CDEM_INLINE void store(double (&p)[lanes], const Oct& v) {
  std::memcpy(p, &v, sizeof v);
}

CDEM_INLINE bool any(const Mask& mask) {
  const auto four =
      __builtin_shufflevector(mask, mask, 0, 1, 2, 3) | __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return (four[0] | four[1] | four[2] | four[3]) != 0;
}

struct Vec {
  Oct x, y, z;
};

CDEM_INLINE Vec minus(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

CDEM_INLINE Vec plus(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

CDEM_INLINE Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

CDEM_INLINE Oct dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

CDEM_INLINE Vec scaled(const Oct& s, const Vec& a) {
  return {s * a.x, s * a.y, s * a.z};
}

// A hint only: `first` may lie beyond the end of its array.
CDEM_INLINE void prefetch(const void* first, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += 64)
    __builtin_prefetch(static_cast<const char*>(first) + i);
}

CDEM_INLINE Oct pair(const Quad& low, const Quad& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

struct Four {
  Oct x, y, z, w;
};

// The four numbers of eight nodes, one node a lane. Nodes i and i + 4 stand in one vector from the start: half the shuffles.
template <class Index>
CDEM_INLINE Four gather_four(const Node* nodes, const Index (&index)[lanes]) {
  const auto two = [&](int i) { return pair(load(nodes[index[i]]), load(nodes[index[i + 4]])); };
  const Oct a = two(0), b = two(1), c = two(2), d = two(3);
  const Oct ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); // a0 b0 a2 b2 ...
  const Oct cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
  const Oct ab_y = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  const Oct cd_y = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab_y, cd_y, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(ab_y, cd_y, 2, 3, 10, 11, 6, 7, 14, 15)};
}

template <class Index>
CDEM_INLINE Vec gather(const Node* nodes, const Index (&index)[lanes]) {
  const Four v = gather_four(nodes, index);
  return {v.x, v.y, v.z};
}

// Adds one lane to each of eight nodes, in lane order (a node may occur twice).
template <class Index>
CDEM_INLINE void scatter_add(Node* nodes, const Index (&index)[lanes], const Vec& v) {
  const Oct zero{};
  const Oct even = __builtin_shufflevector(v.x, v.y, 0, 8, 2, 10, 4, 12, 6, 14); // x0 y0 x2 y2 ...
  const Oct odd = __builtin_shufflevector(v.x, v.y, 1, 9, 3, 11, 5, 13, 7, 15);
  const Oct even_z = __builtin_shufflevector(v.z, zero, 0, 8, 2, 10, 4, 12, 6, 14);
  const Oct odd_z = __builtin_shufflevector(v.z, zero, 1, 9, 3, 11, 5, 13, 7, 15);
  const Oct two[4] = {__builtin_shufflevector(even, even_z, 0, 1, 8, 9, 4, 5, 12, 13),
                      __builtin_shufflevector(odd, odd_z, 0, 1, 8, 9, 4, 5, 12, 13),
                      __builtin_shufflevector(even, even_z, 2, 3, 10, 11, 6, 7, 14, 15),
                      __builtin_shufflevector(odd, odd_z, 2, 3, 10, 11, 6, 7, 14, 15)};
  for (int i = 0; i < 4; ++i)
    store(nodes[index[i]], load(nodes[index[i]]) + __builtin_shufflevector(two[i], two[i], 0, 1, 2, 3));
  for (int i = 0; i < 4; ++i)
    store(nodes[index[4 + i]],
          load(nodes[index[4 + i]]) + __builtin_shufflevector(two[i], two[i], 4, 5, 6, 7));
}

} // namespace simd
} // namespace cdem
