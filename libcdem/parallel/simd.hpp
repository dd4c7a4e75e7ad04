// Eight tets side by side: vectors of eight doubles and the transposes between node records and components.
// Plain compiler vectors: each kernel is compiled for several instruction sets (parallel/instruction_set.hpp); with none
// of them they fall back to pairs.
#pragma once

#include "libcdem/parallel/instruction_set.hpp"
#include "libcdem/parallel/node.hpp"

#include <cstdint>
#include <cstring>

namespace cdem {

// Three numbers of any type, `double` or several side by side: what is written with them is written once for both.
template <class T>
struct Triple {
  T x, y, z;
};

template <class T>
CDEM_INLINE T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
CDEM_INLINE Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
CDEM_INLINE Triple<T> minus(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class T>
CDEM_INLINE Triple<T> plus(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class T>
CDEM_INLINE Triple<T> scaled(const T& s, const Triple<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

namespace simd {

using cdem::cross;
using cdem::dot;
using cdem::minus;
using cdem::plus;
using cdem::scaled;

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

// A kernel that compares and chooses is written for any width V, Oct or Quad. Where vectors hold four doubles, the compiler
// compares the numbers of an Oct one by one, those of a Quad together (parallel/instruction_set.hpp, best_width).
template <class V>
using MaskOf = decltype(V{} < V{});
template <class V>
inline constexpr int width = static_cast<int>(sizeof(V) / sizeof(double));

template <class V>
CDEM_INLINE V load_wide(const double* p) {
  V v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

template <class V>
CDEM_INLINE void store_wide(double* p, const V& v) {
  std::memcpy(p, &v, sizeof v);
}

// Comparisons whose result is kept, combined or asked for are written with `below`, `at_most` and `equal`; one by which something is
// chosen at once may be written as it is. GCC compares eight numbers one by one where it keeps the result: so that of eight is
// made from the bits of their difference, which has the right sign unless one of the two is infinite or no number. For
// one number these are comparisons.
CDEM_INLINE Mask bits_of_difference(const Oct& a, const Oct& b) {
  const Oct difference = a - b;
  Mask bits;
  std::memcpy(&bits, &difference, sizeof bits);
  return bits;
}
CDEM_INLINE Mask where_not_zero(const Mask& bits) {
  return (bits | -bits) >> 63;
}

template <class V>
CDEM_INLINE MaskOf<V> below(const V& a, const V& b) {
  if constexpr (width<V> != lanes) {
    return a < b;
  } else {
    const Mask bits = bits_of_difference(b, a);
    return where_not_zero(bits) & ~(bits >> 63);
  }
}
template <class V>
CDEM_INLINE MaskOf<V> at_most(const V& a, const V& b) {
  if constexpr (width<V> != lanes)
    return a <= b;
  else
    return ~below(b, a);
}
template <class V>
CDEM_INLINE MaskOf<V> equal(const V& a, const V& b) {
  if constexpr (width<V> != lanes)
    return a == b;
  else
    return ~where_not_zero(bits_of_difference(a, b) << 1);
}

// The first lanes of eight, or those from the fifth on.
template <class V, int first>
CDEM_INLINE V part_of(const Oct& v) {
  if constexpr (width<V> == lanes)
    return v;
  else
    return __builtin_shufflevector(v, v, first, first + 1, first + 2, first + 3);
}

template <class V, int first>
CDEM_INLINE void set_part(Oct& v, const V& part) {
  if constexpr (width<V> == lanes)
    v = part;
  else if constexpr (first == 0)
    v = __builtin_shufflevector(part, __builtin_shufflevector(v, v, 4, 5, 6, 7), 0, 1, 2, 3, 4, 5, 6, 7);
  else
    v = __builtin_shufflevector(__builtin_shufflevector(v, v, 0, 1, 2, 3), part, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Of one number, for what is written for one and for several.
CDEM_INLINE bool any(bool one) {
  return one;
}

// A byte for each lane: few instructions on all processors.
CDEM_INLINE bool any(const MaskOf<Quad>& four) {
  using Bytes = signed char __attribute__((vector_size(4)));
  const Bytes bytes = __builtin_convertvector(four, Bytes);
  std::uint32_t all = 0;
  std::memcpy(&all, &bytes, sizeof all);
  return all != 0;
}

CDEM_INLINE bool any(const Mask& mask) {
  using Bytes = signed char __attribute__((vector_size(8)));
  const Bytes bytes = __builtin_convertvector(mask, Bytes);
  std::uint64_t all = 0;
  std::memcpy(&all, &bytes, sizeof all);
  return all != 0;
}

// Whether one of eight numbers is below zero: by their signs, which need no comparison.
CDEM_INLINE bool any_negative(const Oct& v) {
  Mask signs;
  std::memcpy(&signs, &v, sizeof signs);
  const MaskOf<Quad> four =
      __builtin_shufflevector(signs, signs, 0, 1, 2, 3) | __builtin_shufflevector(signs, signs, 4, 5, 6, 7);
  return (four[0] | four[1] | four[2] | four[3]) < 0;
}

// Selects the lanes whose bytes have this value.
template <class V>
CDEM_INLINE MaskOf<V> lanes_with(const std::uint8_t* bytes, std::uint8_t value) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, bytes, width<V>);
  eight ^= 0x0101010101010101u * value;
  MaskOf<V> own;
  for (int lane = 0; lane < width<V>; ++lane)
    own[lane] = static_cast<std::int64_t>(std::uint64_t{0xff} << 8 * lane);
  return ((MaskOf<V>{} + static_cast<std::int64_t>(eight)) & own) == 0;
}

// A bit for each of eight bytes that has this value.
CDEM_INLINE unsigned bits_with(const std::uint8_t* bytes, std::uint8_t value) {
  constexpr std::uint64_t low = 0x7f7f7f7f7f7f7f7fu;
  std::uint64_t eight = 0;
  std::memcpy(&eight, bytes, sizeof eight);
  eight ^= 0x0101010101010101u * value;
  const std::uint64_t zero = ~(((eight & low) + low) | eight | low); // 0x80 where a byte is zero
  return static_cast<unsigned>((zero >> 7) * 0x0102040810204080u >> 56);
}

// Selects the lanes whose bits are set.
template <class V>
CDEM_INLINE MaskOf<V> lanes_of(unsigned bits) {
  MaskOf<V> own;
  for (int lane = 0; lane < width<V>; ++lane)
    own[lane] = std::int64_t{1} << lane;
  return ((MaskOf<V>{} + static_cast<std::int64_t>(bits)) & own) != 0;
}

template <class M>
CDEM_INLINE unsigned bits_of(const M& mask) {
  constexpr int count = static_cast<int>(sizeof(M) / sizeof(std::int64_t));
  M own;
  for (int lane = 0; lane < count; ++lane)
    own[lane] = std::int64_t{1} << lane;
  const M bits = mask & own;
  std::int64_t sum = 0;
  for (int lane = 0; lane < count; ++lane)
    sum |= bits[lane];
  return static_cast<unsigned>(sum);
}

template <class V>
using VecOf = Triple<V>;
using Vec = VecOf<Oct>;

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

// Reads one node a lane; `index` points to the number of the first.
template <class V, class Index>
CDEM_INLINE VecOf<V> gather_wide(const Node* nodes, const Index* index) {
  if constexpr (width<V> == lanes) {
    Index eight[lanes];
    std::memcpy(eight, index, sizeof eight);
    return gather(nodes, eight);
  } else {
    const Quad a = load(nodes[index[0]]), b = load(nodes[index[1]]), c = load(nodes[index[2]]),
               d = load(nodes[index[3]]);
    const Quad ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Quad ab_y = __builtin_shufflevector(a, b, 1, 5, 3, 7),
               cd_y = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab_y, cd_y, 0, 1, 4, 5),
            __builtin_shufflevector(ab, cd, 2, 3, 6, 7)};
  }
}

// Rows become columns: number j of vector i becomes number i of vector j.
CDEM_INLINE void transpose(Oct (&v)[lanes]) {
  Oct pairs[lanes], fours[lanes];
  for (int i = 0; i < lanes; i += 2) {
    pairs[i] = __builtin_shufflevector(v[i], v[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pairs[i + 1] = __builtin_shufflevector(v[i], v[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < lanes; i += 4)
    for (int j = 0; j < 2; ++j) {
      fours[i + j] = __builtin_shufflevector(pairs[i + j], pairs[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      fours[i + j + 2] = __builtin_shufflevector(pairs[i + j], pairs[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int i = 0; i < 4; ++i) {
    v[i] = __builtin_shufflevector(fours[i], fours[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    v[i + 4] = __builtin_shufflevector(fours[i], fours[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

CDEM_INLINE void transpose(Quad (&v)[4]) {
  const Quad a = __builtin_shufflevector(v[0], v[1], 0, 4, 2, 6),
             b = __builtin_shufflevector(v[2], v[3], 0, 4, 2, 6),
             c = __builtin_shufflevector(v[0], v[1], 1, 5, 3, 7),
             d = __builtin_shufflevector(v[2], v[3], 1, 5, 3, 7);
  v[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
  v[1] = __builtin_shufflevector(c, d, 0, 1, 4, 5);
  v[2] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
  v[3] = __builtin_shufflevector(c, d, 2, 3, 6, 7);
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
