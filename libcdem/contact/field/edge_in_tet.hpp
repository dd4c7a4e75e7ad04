// A sharp edge q(t) = q0 + t (q1 - q0), 0 <= t <= 1, in a tetrahedron whose potential phi is linear:
//   U = k / 2 integral phi^2 dt,   k = K w L0 (N/m), over the part of the edge in the tetrahedron,
//   force on q0, q1:  -k grad phi (I - It, It),   I, It = integral of phi, phi t dt
//   force on node k:  +k grad phi (l_k0 (I - It) + l_k1 It).
// phi goes on without a jump from tetrahedron to tetrahedron, so the ends of the part inside add nothing to the
// gradient where K is the same in all of them.
#pragma once

#include "libcdem/contact/field/triangle_in_tet.hpp"

namespace cdem::field {

template <class T>
struct ClippedEdge {
  T length;  // of t
  T i, it;   // m
  T square;  // m2, integral of phi^2 dt
  T deepest; // m
};

// l[k][i]: barycentric k of the edge's end i.
template <class T>
CDEM_INLINE ClippedEdge<T> clip_edge(const T (&values)[4], const T (&l)[4][2]) {
  const T zero = constant<T>(0), one = constant<T>(1);
  T begin = zero, end = one;
  for (int k = 0; k < 4; ++k) {
    const T fa = l[k][0] + outside, fb = l[k][1] + outside;
    const auto in_a = fa >= zero, in_b = fb >= zero;
    const auto crosses = in_a ^ in_b, leaves = in_a & crosses, enters = in_b & crosses, stays = in_a | in_b;
    const T t = fa / (crosses ? fa - fb : one);
    begin = enters ? larger(begin, t) : begin;
    end = leaves ? smaller(end, t) : end;
    end = stays ? end : zero;
  }
  const T a = values[0] * l[0][0] + values[1] * l[1][0] + values[2] * l[2][0] + values[3] * l[3][0];
  const T b = values[0] * l[0][1] + values[1] * l[1][1] + values[2] * l[2][1] + values[3] * l[3][1] - a;
  const auto touches = end - begin > least_area;
  const T d1 = end - begin, d2 = (end * end - begin * begin) / 2.0,
          d3 = (end * end * end - begin * begin * begin) / 3.0;
  ClippedEdge<T> out;
  out.length = touches ? d1 : zero;
  out.i = touches ? a * d1 + b * d2 : zero;
  out.it = touches ? a * d2 + b * d3 : zero;
  out.square = touches ? a * a * d1 + 2.0 * a * b * d2 + b * b * d3 : zero;
  out.deepest = touches ? larger(a + b * begin, a + b * end) : zero;
  return out;
}

template <class T>
CDEM_INLINE Vec<T> potential_gradient(const TetFrame<T>& tet, const T (&values)[4]) {
  Vec<T> sum = {constant<T>(0), constant<T>(0), constant<T>(0)};
  for (int k = 0; k < 3; ++k) {
    const Vec<T> g = scaled(T(values[k + 1] - values[0]), tet.gradient[k]);
    sum = {sum.x + g.x, sum.y + g.y, sum.z + g.z};
  }
  return sum;
}

} // namespace cdem::field
