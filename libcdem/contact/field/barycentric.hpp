// Barycentric coordinates of a point x in a tetrahedron (x0 x1 x2 x3), and their gradients g_k:
//   l_k(x) = g_k . (x - x0),  k = 1, 2, 3;  l_0 = 1 - l_1 - l_2 - l_3
//   g_1 = (e2 x e3) / 6V,  g_2 = (e3 x e1) / 6V,  g_3 = (e1 x e2) / 6V,  e_k = x_k - x0,  6V = e1 . (e2 x e3)
#pragma once

#include "libcdem/contact/field/number.hpp"

namespace cdem::field {

template <class T>
struct TetFrame {
  Vec<T> origin;      // x0, m
  Vec<T> gradient[3]; // g_1, g_2, g_3, 1/m
  T volume6;          // 6V, m3
};

template <class T>
CDEM_INLINE TetFrame<T> tet_frame(const Vec<T> (&x)[4]) {
  const Vec<T> e1 = minus(x[1], x[0]), e2 = minus(x[2], x[0]), e3 = minus(x[3], x[0]);
  const Vec<T> a1 = cross(e2, e3), a2 = cross(e3, e1), a3 = cross(e1, e2);
  const T volume6 = dot(e1, a1), inverse = constant<T>(1) / volume6;
  return {x[0], {scaled(inverse, a1), scaled(inverse, a2), scaled(inverse, a3)}, volume6};
}

template <class T>
CDEM_INLINE void barycentric(const TetFrame<T>& tet, const Vec<T>& x, T (&l)[4]) {
  const Vec<T> d = minus(x, tet.origin);
  for (int k = 0; k < 3; ++k)
    l[k + 1] = dot(tet.gradient[k], d);
  l[0] = constant<T>(1) - l[1] - l[2] - l[3];
}

} // namespace cdem::field
