// Laws of vectors, written once for `double` and for several numbers side by side.
#pragma once

#include "libcdem/parallel/simd.hpp"
#include "libgeom/core/types.hpp"

#include <cmath>

namespace cdem {

template <class T>
CDEM_INLINE Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class T>
CDEM_INLINE Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class T>
CDEM_INLINE Triple<T> operator*(const T& s, const Triple<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

CDEM_INLINE double root(double a) {
  return std::sqrt(a);
}

// Lane by lane: a root is rounded exactly on every processor.
template <class V, class = std::enable_if_t<(sizeof(V) > sizeof(double))>>
CDEM_INLINE V root(const V& a) {
  V r{};
  for (int lane = 0; lane < simd::width<V>; ++lane)
    r[lane] = __builtin_sqrt(a[lane]);
  return r;
}

template <class Mask, class T>
CDEM_INLINE Triple<T> chosen(const Mask& first, const Triple<T>& a, const Triple<T>& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

template <class T>
CDEM_INLINE Triple<T> unit(const Triple<T>& a) {
  const T inverse = 1.0 / root(dot(a, a));
  return inverse * a;
}

CDEM_INLINE Triple<double> triple(const geom::Vec3& a) {
  return {a.x(), a.y(), a.z()};
}

CDEM_INLINE geom::Vec3 vec(const Triple<double>& a) {
  return {a.x, a.y, a.z};
}

} // namespace cdem
