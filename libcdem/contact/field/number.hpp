// Laws of the pressure field are written once for one number or eight side by side: double or simd::Oct. A comparison of
// the one is a bool, of the other a mask; `mask ? a : b` picks lane by lane.
#pragma once

#include "libcdem/parallel/node.hpp"

namespace cdem::field {

template <class T>
CDEM_INLINE T constant(double value) {
  return T{} + value;
}
template <class T>
CDEM_INLINE T larger(const T& a, const T& b) {
  return a > b ? a : b;
}
template <class T>
CDEM_INLINE T smaller(const T& a, const T& b) {
  return a < b ? a : b;
}

template <class T>
struct Vec {
  T x, y, z;
};
template <class T>
CDEM_INLINE Vec<T> minus(const Vec<T>& a, const Vec<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
CDEM_INLINE Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
CDEM_INLINE T dot(const Vec<T>& a, const Vec<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
CDEM_INLINE Vec<T> scaled(const T& s, const Vec<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

} // namespace cdem::field
