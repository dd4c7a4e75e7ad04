// A surface triangle q(u, v) = q0 + u (q1 - q0) + v (q2 - q0) in a tetrahedron whose potential phi is linear:
//   A = integral du dv,  P, Pu, Pv = integral of phi, phi u, phi v du dv   over the part of the triangle in the tetrahedron.
// The energy U = K integral of phi (V0/V) dV over the part of the triangle's body in the tetrahedron depends on the
// triangle by the flux through it alone. With n2 = (q1 - q0) x (q2 - q0), outward, and s = K V0/V its gradient is
//   force on q0, q1, q2:   -s n2 (P - Pu - Pv, Pu, Pv)
//   force on node k:       +s n2 (l_k0 (P - Pu - Pv) + l_k1 Pu + l_k2 Pv),   l_ki: barycentric k of q_i.
// Both sums are equal and opposite, and so are their moments, as sum_k l_k x_k = x.
//
// Clip without branches: the three edges are loose directed segments. Each of the four half spaces l_k >= 0 cuts every
// segment; one closing segment runs from where the outline leaves the half space to where it comes back (3 + 4 + 5 + 6
// = 18 cuts). The moments follow from Green's theorem, segment by segment in any order. The planes stand `outside` the
// faces, so that rounding in a face that lies in a plane does not make the outline cross it more than once.
#pragma once

#include "libcdem/contact/field/barycentric.hpp"

namespace cdem::field {

// Of the barycentric coordinate: how far outside its face the cutting plane stands.
inline constexpr double outside = 1e-13;
// Of the triangle's area: less than this is rounding, not contact.
inline constexpr double least_area = 1e-11;

template <class T>
struct ClippedTriangle {
  T area;      // A, of the triangle's parameters: 1/2 when all of it is inside
  T p, pu, pv; // m
  T deepest;   // m, largest phi on it
};

template <class T>
struct Segment {
  T ua, va, ub, vb;
};

// values: phi at the four nodes, m; l[k][i]: barycentric k of the triangle's corner i.
template <class T>
CDEM_INLINE ClippedTriangle<T> clip_triangle(const T (&values)[4], const T (&l)[4][3]) {
  const T zero = constant<T>(0), one = constant<T>(1);
  Segment<T> s[7] = {{zero, zero, one, zero}, {one, zero, zero, one}, {zero, one, zero, zero}};
  for (int k = 0; k < 4; ++k) {
    const T f0 = l[k][0] + outside, fu = l[k][1] - l[k][0], fv = l[k][2] - l[k][0];
    Segment<T> closing = {zero, zero, zero, zero};
    for (int i = 0; i < 3 + k; ++i) {
      Segment<T>& c = s[i];
      const T fa = f0 + c.ua * fu + c.va * fv, fb = f0 + c.ub * fu + c.vb * fv;
      const auto in_a = fa >= zero, in_b = fb >= zero;
      const auto crosses = in_a ^ in_b, leaves = in_a & crosses, enters = in_b & crosses, stays = in_a | in_b;
      const T t = fa / (crosses ? fa - fb : one);
      const T ut = c.ua + t * (c.ub - c.ua), vt = c.va + t * (c.vb - c.va);
      closing.ua = leaves ? ut : closing.ua;
      closing.va = leaves ? vt : closing.va;
      closing.ub = enters ? ut : closing.ub;
      closing.vb = enters ? vt : closing.vb;
      // What is outside shrinks to a point, which adds nothing.
      c.ua = stays ? (enters ? ut : c.ua) : zero;
      c.va = stays ? (enters ? vt : c.va) : zero;
      c.ub = stays ? (leaves ? ut : c.ub) : zero;
      c.vb = stays ? (leaves ? vt : c.vb) : zero;
    }
    s[3 + k] = closing;
  }
  const auto phi_at = [&](int i) {
    return values[0] * l[0][i] + values[1] * l[1][i] + values[2] * l[2][i] + values[3] * l[3][i];
  };
  const T p0 = phi_at(0), pu = phi_at(1) - p0, pv = phi_at(2) - p0;
  T a = zero, mu = zero, mv = zero, muu = zero, muv = zero, mvv = zero, deepest = zero;
  for (const Segment<T>& c : s) {
    const T w = c.ua * c.vb - c.ub * c.va;
    a += 0.5 * w;
    mu += w * (c.ua + c.ub) / 6.0;
    mv += w * (c.va + c.vb) / 6.0;
    muu += w * (c.ua * c.ua + c.ua * c.ub + c.ub * c.ub) / 12.0;
    mvv += w * (c.va * c.va + c.va * c.vb + c.vb * c.vb) / 12.0;
    muv += w * (2.0 * c.ua * c.va + c.ua * c.vb + c.ub * c.va + 2.0 * c.ub * c.vb) / 24.0;
    const auto there = (c.ua != c.ub) | (c.va != c.vb);
    const T at_a = p0 + c.ua * pu + c.va * pv, at_b = p0 + c.ub * pu + c.vb * pv;
    deepest = there ? larger(deepest, larger(at_a, at_b)) : deepest;
  }
  const auto touches = a > 0.5 * least_area;
  ClippedTriangle<T> out;
  out.area = touches ? a : zero;
  out.p = touches ? p0 * a + pu * mu + pv * mv : zero;
  out.pu = touches ? p0 * mu + pu * muu + pv * muv : zero;
  out.pv = touches ? p0 * mv + pu * muv + pv * mvv : zero;
  out.deepest = touches ? deepest : zero;
  return out;
}

// Forces per s (the stiffness K V0/V, Pa/m), m3.
template <class T>
struct FieldForces {
  Vec<T> on_source[3], on_target[4];
};

template <class T>
CDEM_INLINE FieldForces<T> field_forces(const Vec<T>& n2, const ClippedTriangle<T>& c, const T (&l)[4][3]) {
  const T w[3] = {c.p - c.pu - c.pv, c.pu, c.pv};
  FieldForces<T> f;
  for (int i = 0; i < 3; ++i)
    f.on_source[i] = scaled(T(-w[i]), n2);
  for (int k = 0; k < 4; ++k)
    f.on_target[k] = scaled(T(l[k][0] * w[0] + l[k][1] * w[1] + l[k][2] * w[2]), n2);
  return f;
}

} // namespace cdem::field
