// Potential of two tetrahedra that overlap, and its gradient: pure functions, for one pair or several side by side.
//
// Inside the target tetrahedron stands the field
//
//   phi(x) = min over its planes k of D_k(x),   D_k = depth of x below plane k, less phi0
//
// The corners, the edges and the middles of the faces of the other tetrahedron, the source, lie in it. With the stiffness k of the
// pair (N/m):
//
//   U = k/4 (sum over corners of phi+^2 + 1/2 sum over edges of the mean of phi^2 over the part of the edge where phi > 0
//            + 6 sum over faces of phi+^2 in their middles)
//
// and the same the other way round. Over an edge phi is linear piece by piece, so the mean is closed, and the forces at all
// eight corners are the exact gradient of U: they keep momentum, angular momentum and energy. With the integral over the whole
// edge in place of the mean, edges that cross would hardly press, as a small part of them is inside. A corner in a flat face has
// the force 3/4 k phi, a third of it by its edges, as three semi-springs. Where two faces lie on each other as they did in the
// mesh, corners and edges lie on planes of the other one: the middles of the faces alone carry.
// phi0 (m) is the overlap that a pair may have without a force.
#pragma once

#include "libcdem/parallel/triple.hpp"

#include <array>
#include <utility>

namespace cdem {

inline constexpr std::array<std::array<int, 3>, 4> planes_of_tet{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
inline constexpr std::array<std::array<int, 2>, 6> edges_of_tet{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

namespace simd {

template <class V>
CDEM_INLINE V least(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
CDEM_INLINE V most(const V& a, const V& b) {
  return a > b ? a : b;
}
} // namespace simd

template <class V>
using TetCorners = std::array<Triple<V>, 4>; // m

// How the corners of a source stand to the planes of a target.
template <class V>
struct DepthsInTet {
  std::array<Triple<V>, 4> normal;       // of planes, unit, outwards
  std::array<V, 4> reciprocal;           // 1/m2, of twice their areas
  std::array<std::array<V, 4>, 4> depth; // m, below plane [k], of corner [i]
};

template <class V>
CDEM_INLINE DepthsInTet<V> depths_in_tet(const TetCorners<V>& target, const TetCorners<V>& source) {
  DepthsInTet<V> at;
  for (int k = 0; k < 4; ++k) {
    const Triple<V>& foot = target[planes_of_tet[k][0]];
    const Triple<V> n =
        cross(minus(target[planes_of_tet[k][1]], foot), minus(target[planes_of_tet[k][2]], foot));
    at.reciprocal[k] = 1.0 / root(dot(n, n));
    at.normal[k] = scaled(at.reciprocal[k], n);
    for (int i = 0; i < 4; ++i)
      at.depth[k][i] = -dot(at.normal[k], minus(source[i], foot));
  }
  return at;
}

// m, by which one plane of the target parts it from the whole source, at least; below 0: none does.
template <class V>
CDEM_INLINE V parted_by_plane(const DepthsInTet<V>& at) {
  V apart = V{} - 1e300;
  for (int k = 0; k < 4; ++k) {
    const auto& d = at.depth[k];
    apart = simd::most<V>(apart, -simd::most<V>(simd::most<V>(d[0], d[1]), simd::most<V>(d[2], d[3])));
  }
  return apart;
}

// Shares of U, over that of a corner. The faces of the source are the planes of the target: as many.
inline constexpr double edge_share = 0.5, middle_share = 6;

// m, min over k of D_k in the middle of a face of the source.
template <class V>
CDEM_INLINE V in_middle(const DepthsInTet<V>& at, const std::array<int, 3>& face) {
  V least = V{} + 1e300;
  for (int k = 0; k < 4; ++k) {
    const auto& d = at.depth[k];
    least = simd::least<V>(least, (1.0 / 3) * (d[face[0]] + d[face[1]] + d[face[2]]));
  }
  return least;
}

// m, that no corner, no edge and no middle of a face of the source is deeper than.
template <class V>
CDEM_INLINE V no_deeper_than(const DepthsInTet<V>& at) {
  const auto& d = at.depth;
  V deepest = V{} - 1e300;
  for (int edge = 0; edge < 6; ++edge) {
    const int p = edges_of_tet[edge][0], q = edges_of_tet[edge][1];
    V on_edge = simd::most<V>(d[0][p], d[0][q]);
    for (int k = 1; k < 4; ++k)
      on_edge = simd::least<V>(on_edge, simd::most<V>(d[k][p], d[k][q]));
    deepest = simd::most<V>(deepest, on_edge);
  }
  for (const std::array<int, 3>& face : planes_of_tet)
    deepest = simd::most<V>(deepest, in_middle<V>(at, face));
  return simd::least<V>(deepest, -parted_by_plane<V>(at));
}

// m, the largest min over k of D_k on the corners, edges and middles of faces of the source; below 0: as far, at least, they all stand
// outside.
template <class V>
CDEM_INLINE V deepest_in_tet(const DepthsInTet<V>& at) {
  const auto& d = at.depth;
  V deepest = V{} - 1e300;
  for (int i = 0; i < 4; ++i)
    deepest = simd::most<V>(
        deepest, simd::least<V>(simd::least<V>(d[0][i], d[1][i]), simd::least<V>(d[2][i], d[3][i])));
  for (const std::array<int, 3>& face : planes_of_tet)
    deepest = simd::most<V>(deepest, in_middle<V>(at, face));
  const V zero{}, one = zero + 1.0, nowhere = zero - 1e300;
  for (int edge = 0; edge < 6; ++edge) {
    const int p = edges_of_tet[edge][0], q = edges_of_tet[edge][1];
    V at_most = simd::most<V>(d[0][p], d[0][q]); // on the edge
    for (int k = 1; k < 4; ++k)
      at_most = simd::least<V>(at_most, simd::most<V>(d[k][p], d[k][q]));
    if (!simd::any(simd::below<V>(deepest, at_most)))
      continue;
    for (int k = 0; k < 4; ++k)
      for (int j = k + 1; j < 4; ++j) {
        const V a = d[j][p] - d[k][p], b = d[j][q] - d[k][q];
        const simd::MaskOf<V> crosses = (simd::below<V>(a, zero) & simd::below<V>(zero, b)) |
                                        (simd::below<V>(zero, a) & simd::below<V>(b, zero));
        if (!simd::any(crosses))
          continue;
        const V t = a / (crosses ? a - b : one);
        V here = d[0][p] + t * (d[0][q] - d[0][p]);
        for (int l = 1; l < 4; ++l)
          here = simd::least<V>(here, d[l][p] + t * (d[l][q] - d[l][p]));
        deepest = simd::most<V>(deepest, crosses ? here : nowhere);
      }
  }
  return deepest;
}

// Adds the forces of the source in the target's field to both, N. Returns U, J. k: N/m.
template <class V>
CDEM_INLINE V press_into_tet(const TetCorners<V>& target, const TetCorners<V>& source, const V& phi0,
                             const V& k, TetCorners<V>& on_target, TetCorners<V>& on_source) {
  using Mask = simd::MaskOf<V>;
  DepthsInTet<V> at = depths_in_tet<V>(target, source);
  auto& d = at.depth;
  const V zero{}, one = zero + 1.0, never = zero + 2.0, half = 0.5 * k;
  std::array<std::array<V, 4>, 4> share{}; // N, of plane [k], at corner [i] of the source
  for (int plane = 0; plane < 4; ++plane)
    for (int i = 0; i < 4; ++i)
      d[plane][i] -= phi0;
  V energy{};
  for (int i = 0; i < 4; ++i) {
    const V phi = simd::least<V>(simd::least<V>(d[0][i], d[1][i]), simd::least<V>(d[2][i], d[3][i]));
    const Mask inside = simd::below<V>(zero, phi);
    if (!simd::any(inside))
      continue;
    const V pressed = inside ? half * phi : zero;
    energy += 0.5 * pressed * phi;
    Mask used{};
    for (int plane = 0; plane < 4; ++plane) {
      const Mask here = simd::equal<V>(d[plane][i], phi) & ~used;
      used |= here;
      share[plane][i] += here ? pressed : zero;
    }
  }
  for (const std::array<int, 3>& face : planes_of_tet) {
    const V phi = in_middle<V>(at, face);
    const Mask inside = simd::below<V>(zero, phi);
    if (!simd::any(inside))
      continue;
    const V pressed = inside ? middle_share * half * phi : zero;
    energy += 0.5 * pressed * phi;
    Mask used{};
    for (int plane = 0; plane < 4; ++plane) {
      const auto& at_plane = d[plane];
      const V third = (1.0 / 3) * pressed;
      const Mask here =
          simd::equal<V>((1.0 / 3) * (at_plane[face[0]] + at_plane[face[1]] + at_plane[face[2]]), phi) &
          ~used;
      used |= here;
      for (const int i : face)
        share[plane][i] += here ? third : zero;
    }
  }
  for (int edge = 0; edge < 6; ++edge) {
    const int p = edges_of_tet[edge][0], q = edges_of_tet[edge][1];
    // The part of the edge inside all planes.
    V from = zero, to = one;
    Mask outside{};
    std::array<V, 4> cut; // where it meets the plane
    for (int plane = 0; plane < 4; ++plane) {
      const V a = d[plane][p], b = d[plane][q];
      const Mask starts_out = simd::below<V>(a, zero), ends_out = simd::below<V>(b, zero);
      outside |= simd::at_most<V>(a, zero) & simd::at_most<V>(b, zero);
      const V t = cut[plane] = a / (a == b ? one : a - b);
      from = simd::most<V>(from, starts_out ? (ends_out ? never : t) : zero);
      to = simd::least<V>(to, ends_out ? t : one);
    }
    const Mask enters = simd::below<V>(from, to) & ~outside;
    if (!simd::any(enters))
      continue;
    const V per_part = 1.0 / (enters ? to - from : one), weight = edge_share * half * per_part;
    V of_edge{};
    // Of each plane, the part where it is the nearest.
    std::array<V, 4> begin, end;
    begin.fill(from);
    end.fill(to);
    for (int plane = 0; plane < 4; ++plane)
      for (int other = plane + 1; other < 4; ++other) {
        const V a = d[other][p] - d[plane][p], b = d[other][q] - d[plane][q]; // at least 0: `plane` is nearer
        const V t = a / (a == b ? one : a - b);
        const Mask starts_far = simd::below<V>(a, zero), ends_far = simd::below<V>(b, zero);
        begin[plane] = simd::most<V>(begin[plane], starts_far ? (ends_far ? never : t) : zero);
        end[plane] = simd::least<V>(end[plane], ends_far ? t : one);
        begin[other] = simd::most<V>(begin[other], starts_far ? zero : (ends_far ? t : never));
        end[other] = simd::least<V>(end[other], ends_far ? one : t);
      }
    for (int plane = 0; plane < 4; ++plane) {
      const Mask there = simd::below<V>(begin[plane], end[plane]) & ~outside;
      if (!simd::any(there))
        continue;
      const V a = begin[plane], b = there ? end[plane] : a, w = b - a;
      const V grows = d[plane][q] - d[plane][p], fa = d[plane][p] + grows * a, fb = d[plane][p] + grows * b;
      const V all = 0.5 * w * (fa + fb), squares = (1.0 / 3) * w * (fa * fa + fa * fb + fb * fb),
              moment = (1.0 / 6) * w * (fa * (2.0 * a + b) + fb * (a + 2.0 * b));
      of_edge += 0.5 * weight * squares;
      share[plane][q] += weight * moment;
      share[plane][p] += weight * (all - moment);
    }
    energy += of_edge;
    // The larger the part, the smaller the mean.
    const V by_part = per_part * of_edge;
    Mask begins{}, ends{};
    for (int plane = 0; plane < 4; ++plane) {
      const V a = d[plane][p], b = d[plane][q], t = cut[plane];
      const Mask begins_here = enters & simd::below<V>(a, zero) & simd::equal<V>(t, from) & ~begins,
                 ends_here = enters & simd::below<V>(b, zero) & simd::equal<V>(t, to) & ~ends;
      begins |= begins_here;
      ends |= ends_here;
      const V moves = (begins_here ? by_part : ends_here ? -by_part : zero) / (a == b ? one : a - b);
      share[plane][p] += moves * (1.0 - t);
      share[plane][q] += moves * t;
    }
  }
  for (int plane = 0; plane < 4; ++plane) {
    const auto& s = share[plane];
    V largest = zero;
    for (const V& at_corner : s)
      largest = simd::most<V>(largest, simd::most<V>(at_corner, -at_corner));
    if (!simd::any(simd::below<V>(zero, largest)))
      continue;
    const V sum = s[0] + s[1] + s[2] + s[3];
    const Triple<V>& n = at.normal[plane];
    Triple<V> moment = scaled(s[0], source[0]);
    for (int i = 1; i < 4; ++i)
      moment = plus(moment, scaled(s[i], source[i]));
    for (int i = 0; i < 4; ++i)
      on_source[i] = plus(on_source[i], scaled(s[i], n));
    for (int j = 0; j < 3; ++j) {
      const int own = planes_of_tet[plane][j];
      const Triple<V>&y1 = target[planes_of_tet[plane][(j + 1) % 3]],
            &y2 = target[planes_of_tet[plane][(j + 2) % 3]];
      const Triple<V> g = cross(n, minus(y2, y1)), arm = minus(moment, scaled(sum, y1));
      on_target[own] = minus(on_target[own], scaled(V(dot(g, arm) * at.reciprocal[plane]), n));
    }
  }
  return energy;
}

// Some pairs side by side, as kernels read them: nodes 0 to 3 are those of the first tetrahedron, 4 to 7 those of the second.
struct TetPairView {
  std::int32_t node[8][lanes];
  // m, the largest overlap; below 0: the two are at least as far from each other.
  double deepest[lanes];

  void set(int lane, const std::array<int, 4>& a, const std::array<int, 4>& b) {
    for (int k = 0; k < 4; ++k) {
      node[k][lane] = a[k];
      node[4 + k][lane] = b[k];
    }
  }
};

struct TetPairPress {
  TetPairView of;
  double phi0[lanes];        // m
  double stiffness[lanes];   // N/m
  double energy[lanes];      // J
  double force[8][3][lanes]; // N

  std::array<double, 3> at(int corner, int lane) const {
    return {force[corner][0][lane], force[corner][1][lane], force[corner][2][lane]};
  }
};

// place: m, of nodes (x, y, z). The first writes into `deepest` what is at least as large, and costs less.
void bound_deepest(const Node* place, TetPairView*, std::int64_t count);
void find_deepest(const Node* place, TetPairView*, std::int64_t count);
void press_pairs(const Node* place, TetPairPress*, std::int64_t count);

} // namespace cdem
