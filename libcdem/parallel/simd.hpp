// Eight tets side by side: vectors of eight doubles and the transposes between node records and components.
// Plain compiler vectors: each kernel is compiled for several instruction sets and picks one at run time
// (CDEM_KERNEL); with none of them they fall back to pairs.
#pragma once

#include "libcdem/parallel/node.hpp"

#include <cstring>

#if defined(__clang__)
#define CDEM_KERNEL
#else
#define CDEM_KERNEL __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif

namespace cdem {

namespace simd {

using Quad = double __attribute__((vector_size(32)));
using Oct = double __attribute__((vector_size(64)));

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

CDEM_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab_lo = __builtin_shufflevector(a, b, 0, 4, 2, 6); // a0 b0 a2 b2
  const Quad ab_hi = __builtin_shufflevector(a, b, 1, 5, 3, 7); // a1 b1 a3 b3
  const Quad cd_lo = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Quad cd_hi = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_lo, cd_lo, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_hi, cd_hi, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_lo, cd_lo, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_hi, cd_hi, 2, 3, 6, 7);
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

// x, y, z of eight nodes, one node a lane.
// A hint only: `first` may lie beyond the end of its array.
CDEM_INLINE void prefetch(const void* first, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += 64)
    __builtin_prefetch(static_cast<const char*>(first) + i);
}

template <class Index>
CDEM_INLINE Vec gather(const Node* nodes, const Index (&index)[lanes]) {
  Quad r[lanes];
  for (int i = 0; i < lanes; ++i)
    r[i] = load(nodes[index[i]]);
  transpose(r[0], r[1], r[2], r[3]);
  transpose(r[4], r[5], r[6], r[7]);
  return {__builtin_shufflevector(r[0], r[4], 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(r[1], r[5], 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(r[2], r[6], 0, 1, 2, 3, 4, 5, 6, 7)};
}

// Adds one lane to each of eight nodes, in lane order (a node may occur twice).
template <class Index>
CDEM_INLINE void scatter_add(Node* nodes, const Index (&index)[lanes], const Vec& v) {
  const Quad zero{};
  Quad lo[4] = {__builtin_shufflevector(v.x, v.x, 0, 1, 2, 3), __builtin_shufflevector(v.y, v.y, 0, 1, 2, 3),
                __builtin_shufflevector(v.z, v.z, 0, 1, 2, 3), zero};
  Quad hi[4] = {__builtin_shufflevector(v.x, v.x, 4, 5, 6, 7), __builtin_shufflevector(v.y, v.y, 4, 5, 6, 7),
                __builtin_shufflevector(v.z, v.z, 4, 5, 6, 7), zero};
  transpose(lo[0], lo[1], lo[2], lo[3]);
  transpose(hi[0], hi[1], hi[2], hi[3]);
  for (int i = 0; i < 4; ++i)
    store(nodes[index[i]], load(nodes[index[i]]) + lo[i]);
  for (int i = 0; i < 4; ++i)
    store(nodes[index[4 + i]], load(nodes[index[4 + i]]) + hi[i]);
}

} // namespace simd
} // namespace cdem
