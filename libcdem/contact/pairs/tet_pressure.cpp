#include "libcdem/contact/pairs/tet_pressure.hpp"

#include "libcdem/parallel/simd.hpp"
#include "libgeom/core/types.hpp"

#include "libcdem/parallel/triple.hpp"

#include <algorithm>

namespace cdem {
namespace {

using simd::MaskOf;
using simd::VecOf;
using simd::width;

constexpr int face_of[4][3] = {
    {1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; // by the corner opposite, seen from outside
constexpr int edge_of[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr double far_off = 1e300;
constexpr double opposed = -0.1; // cosine between the normals of two faces that press on each other, at most

template <class V>
CDEM_INLINE V smaller(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
CDEM_INLINE V larger(const V& a, const V& b) {
  return a > b ? a : b;
}
template <class V>
CDEM_INLINE V least_of(const V (&v)[4]) {
  return smaller(smaller(v[0], v[1]), smaller(v[2], v[3]));
}
template <class V>
CDEM_INLINE V where(const MaskOf<V>& mask, const V& v) {
  const V zero{};
  return mask ? v : zero;
}

// Some pairs from the i-th on; lanes behind the last one repeat it.
template <class V>
struct PairsAtOnce {
  std::int32_t a[width<V>], b[width<V>];
};

template <class V>
CDEM_INLINE PairsAtOnce<V> several(const PairsOfTets& pairs, std::int64_t first) {
  PairsAtOnce<V> of;
  for (int lane = 0; lane < width<V>; ++lane) {
    const std::int64_t i = first + lane < pairs.count ? first + lane : pairs.count - 1;
    of.a[lane] = pairs.a[pairs.row[i]];
    of.b[lane] = pairs.b[pairs.row[i]];
  }
  return of;
}

template <class V>
CDEM_INLINE void gather_corners(const Node* at, const std::int32_t (&tet)[width<V>], VecOf<V> (&x)[4]) {
  for (int k = 0; k < 4; ++k) {
    std::int32_t index[width<V>];
    for (int lane = 0; lane < width<V>; ++lane)
      index[lane] = 4 * tet[lane] + k;
    x[k] = simd::gather_wide<V>(at, index);
  }
}

// Seen from the first corner of a.
template <class V>
CDEM_INLINE void gather_pair(const PairsOfTets& pairs, std::int64_t first, VecOf<V> (&a)[4], VecOf<V> (&b)[4]) {
  const PairsAtOnce<V> of = several<V>(pairs, first);
  gather_corners(pairs.place, of.a, a);
  gather_corners(pairs.place, of.b, b);
  const VecOf<V> origin = a[0];
  for (int k = 0; k < 4; ++k) {
    a[k] = simd::minus(a[k], origin);
    b[k] = simd::minus(b[k], origin);
  }
}

template <class V>
CDEM_INLINE VecOf<V> normal_of(const VecOf<V> (&x)[4], int k) {
  const VecOf<V>& foot = x[face_of[k][0]];
  return simd::cross(simd::minus(x[face_of[k][1]], foot), simd::minus(x[face_of[k][2]], foot));
}

template <class V>
CDEM_INLINE VecOf<V> unit_normal(const VecOf<V> (&x)[4], int k) {
  const VecOf<V> n = normal_of(x, k);
  return simd::scaled(1.0 / root(simd::dot(n, n)), n);
}

// How much one of the planes of p parts q from it.
template <class V>
CDEM_INLINE V parted(const VecOf<V> (&p)[4], const VecOf<V> (&q)[4]) {
  V best = V{} - far_off;
  for (int k = 0; k < 4; ++k) {
    const VecOf<V> n = normal_of(p, k);
    const V level = simd::dot(n, p[face_of[k][0]]);
    const V height[4] = {simd::dot(n, q[0]) - level, simd::dot(n, q[1]) - level, simd::dot(n, q[2]) - level,
                           simd::dot(n, q[3]) - level};
    best = larger(best, least_of(height) / root(simd::dot(n, n)));
  }
  return best;
}

template <class V>
CDEM_INLINE void planes_kernel(const PairsOfTets& pairs, double* gap) {
  for (std::int64_t i = 0; i < pairs.count; i += width<V>) {
    VecOf<V> a[4], b[4];
    gather_pair(pairs, i, a, b);
    const V most = larger(parted(a, b), parted(b, a));
    for (int lane = 0; lane < width<V> && i + lane < pairs.count; ++lane)
      gap[i + lane] = most[lane];
  }
}

// Of the corners of q in the field of p.
template <class V>
struct Field {
  VecOf<V> normal[4];   // unit, outwards
  V inverse[4];  // 1/m2, over twice the areas
  V depth[4][4]; // m, D_k of each corner
};

// Which planes are open, and which corners and edges belong to an open face.
template <class V>
struct Open {
  MaskOf<V> plane[4];
  MaskOf<V> all() const { return plane[0] & plane[1] & plane[2] & plane[3]; }
  MaskOf<V> corner(int i) const {
    return plane[(i + 1) % 4] | plane[(i + 2) % 4] | plane[(i + 3) % 4];
  }
  MaskOf<V> edge(int i, int j) const { // of the two faces beside it
    MaskOf<V> any{};
    for (int face = 0; face < 4; ++face)
      if (face != i && face != j)
        any |= plane[face];
    return any;
  }
};

template <class V>
CDEM_INLINE Open<V> open_planes(const PairsOfTets& pairs, const std::int32_t (&tet)[width<V>]) {
  MaskOf<V> bits;
  for (int lane = 0; lane < width<V>; ++lane)
    bits[lane] = pairs.open[tet[lane]];
  Open<V> open;
  for (int k = 0; k < 4; ++k)
    open.plane[k] = (bits & (std::int64_t{1} << k)) != 0;
  return open;
}

template <class V>
CDEM_INLINE Field<V> field_of(const VecOf<V> (&p)[4], const VecOf<V> (&q)[4], const V& offset) {
  Field<V> f;
  for (int k = 0; k < 4; ++k) {
    const VecOf<V> n = normal_of(p, k);
    f.inverse[k] = 1.0 / root(simd::dot(n, n));
    f.normal[k] = simd::scaled(f.inverse[k], n);
    const V level = simd::dot(f.normal[k], p[face_of[k][0]]) - offset;
    for (int i = 0; i < 4; ++i)
      f.depth[k][i] = level - simd::dot(f.normal[k], q[i]);
  }
  return f;
}

// Along an edge phi is the least of four linear functions. Its largest value is that of two of them alone, since one place and
// one value are sought: at an end, or where the two are equal.
template <class V>
CDEM_INLINE V largest_phi(const Field<V>& f) {
  const V one = V{} + 1.0;
  V best = V{} - far_off;
  for (int i = 0; i < 4; ++i) {
    const V here[4] = {f.depth[0][i], f.depth[1][i], f.depth[2][i], f.depth[3][i]};
    best = larger(best, least_of(here));
  }
  for (const auto& [i, j] : edge_of) {
    V most = V{} + far_off;
    for (int k = 0; k < 4; ++k)
      most = smaller(most, larger(f.depth[k][i], f.depth[k][j]));
    if (!simd::any(most > best))
      continue;
    for (int k = 0; k < 4; ++k)
      for (int l = k + 1; l < 4; ++l) {
        const V at_i = f.depth[l][i] - f.depth[k][i], at_j = f.depth[l][j] - f.depth[k][j];
        const MaskOf<V> meet = (at_i < 0.0) != (at_j < 0.0);
        const V t = at_i / (meet ? at_i - at_j : one);
        const V ends = larger(smaller(f.depth[k][i], f.depth[l][i]), smaller(f.depth[k][j], f.depth[l][j]));
        const V there = f.depth[k][i] + t * (f.depth[k][j] - f.depth[k][i]);
        most = smaller(most, meet ? larger(ends, there) : ends);
      }
    best = larger(best, most);
  }
  return best;
}

template <class V>
CDEM_INLINE void deepest_kernel(const PairsOfTets& pairs, const double* offset, double* phi) {
  for (std::int64_t i = 0; i < pairs.count; i += width<V>) {
    VecOf<V> a[4], b[4];
    gather_pair(pairs, i, a, b);
    V off{};
    for (int lane = 0; lane < width<V>; ++lane)
      off[lane] = offset[std::min(i + lane, pairs.count - 1)];
    const V most = larger(largest_phi(field_of(a, b, off)), largest_phi(field_of(b, a, off)));
    for (int lane = 0; lane < width<V> && i + lane < pairs.count; ++lane)
      phi[i + lane] = most[lane];
  }
}

template <class V>
struct PressureSums {
  V stored{}, stiffness{}, depth{};
};

// The part of an edge on which phi is D_k > 0.
template <class V>
struct Stretch {
  V from, to;
};

// Cuts it to where a linear function with these values at the ends of the edge is not below 0.
template <class V>
CDEM_INLINE void cut(Stretch<V>& s, const V& at_i, const V& at_j) {
  const V one = V{} + 1.0, zero{}, never = V{} + 2.0;
  const V t = at_i / (at_i == at_j ? one : at_i - at_j);
  const MaskOf<V> below_i = at_i < 0.0, below_j = at_j < 0.0;
  s.from = larger(s.from, below_i ? (below_j ? never : t) : zero);
  s.to = smaller(s.to, below_j ? t : one);
}

// share[k][i]: N, of what presses on plane k the part at corner i of q.
template <class V>
CDEM_INLINE void press_corners(const Field<V>& f, const V (&open)[4][4], const Open<V>& source, const V& kappa,
                               V (&share)[4][4], PressureSums<V>& sums) {
  for (int i = 0; i < 4; ++i) {
    const V all[4] = {f.depth[0][i], f.depth[1][i], f.depth[2][i], f.depth[3][i]},
            here[4] = {open[0][i], open[1][i], open[2][i], open[3][i]};
    const V phi = least_of(here);
    const MaskOf<V> in = (least_of(all) > 0.0) & (phi < far_off) & source.corner(i);
    if (!simd::any(in))
      continue;
    const V force = where(in, kappa * phi);
    sums.stored += 0.5 * force * phi;
    sums.stiffness += where(in, kappa);
    sums.depth = larger(sums.depth, where(in, phi));
    MaskOf<V> taken{};
    for (int k = 0; k < 4; ++k) {
      const MaskOf<V> is = (here[k] == phi) & ~taken;
      taken |= is;
      share[k][i] += where(is, force);
    }
  }
}

template <class V>
CDEM_INLINE void press_edges(const Field<V>& f, const V (&open)[4][4], const Open<V>& target,
                             const Open<V>& source, const V& kappa, V (&share)[4][4], PressureSums<V>& sums) {
  for (const auto& [i, j] : edge_of) {
    MaskOf<V> out = ~source.edge(i, j);
    for (int k = 0; k < 4; ++k)
      out |= (f.depth[k][i] <= 0.0) & (f.depth[k][j] <= 0.0);
    if (!simd::any(~out))
      continue;
    Stretch<V> inside{V{}, V{} + 1.0};
    for (int k = 0; k < 4; ++k)
      cut(inside, f.depth[k][i], f.depth[k][j]);
    if (!simd::any((inside.to > inside.from) & ~out))
      continue;
    Stretch<V> of[4] = {inside, inside, inside, inside};
    for (int k = 0; k < 4; ++k)
      for (int l = k + 1; l < 4; ++l) {
        const V at_i = open[l][i] - open[k][i], at_j = open[l][j] - open[k][j];
        const V one = V{} + 1.0, zero{}, never = V{} + 2.0;
        const V t =
            at_i / (at_i == at_j ? one : at_i - at_j); // k is nearer where the difference is above 0
        const MaskOf<V> below_i = at_i < 0.0, below_j = at_j < 0.0;
        of[k].from = larger(of[k].from, below_i ? (below_j ? never : t) : zero);
        of[k].to = smaller(of[k].to, below_j ? t : one);
        of[l].from = larger(of[l].from, below_i ? zero : (below_j ? t : never));
        of[l].to = smaller(of[l].to, below_j ? one : t);
      }
    for (int k = 0; k < 4; ++k) {
      const MaskOf<V> acts = (of[k].to > of[k].from) & ~out & target.plane[k];
      if (!simd::any(acts))
        continue;
      const V from = of[k].from, to = acts ? of[k].to : from, width = to - from;
      const V slope = f.depth[k][j] - f.depth[k][i];
      const V first = f.depth[k][i] + slope * from, last = f.depth[k][i] + slope * to;
      const V sum = 0.5 * width * (first + last),
                squares = width * (first * first + first * last + last * last) * (1.0 / 3),
                moment = width * (first * (2.0 * from + to) + last * (from + 2.0 * to)) * (1.0 / 6);
      sums.stored += where(acts, 0.5 * kappa * squares);
      sums.stiffness += where(acts, kappa * width);
      sums.depth = larger(sums.depth, where(acts, larger(first, last)));
      share[k][j] += where(acts, kappa * moment);
      share[k][i] += where(acts, kappa * (sum - moment));
    }
  }
}

// What the corners and edges of q do in the field of p. facing: unit, normals of q.
template <class V>
CDEM_INLINE void press_into(const VecOf<V> (&p)[4], const VecOf<V> (&q)[4], const VecOf<V> (&facing)[4],
                            const Open<V>& target, const Open<V>& source, const V& rim, const V& offset, const V& kappa, VecOf<V> (&on_p)[4],
                            VecOf<V> (&on_q)[4], PressureSums<V>& sums) {
  Field<V> f = field_of(p, q, offset);
  const V never_near = V{} + far_off;
  const V zero{};
  const MaskOf<V> single = target.all() & source.all();
  Open<V> near = target;
  V open[4][4]; // m, as Field::depth, of planes that may be the nearest
  for (int k = 0; k < 4; ++k) {
    MaskOf<V> faces = source.plane[0] & (simd::dot(f.normal[k], facing[0]) < opposed);
    for (int j = 1; j < 4; ++j)
      faces |= source.plane[j] & (simd::dot(f.normal[k], facing[j]) < opposed);
    const MaskOf<V> beyond = (f.depth[k][0] + f.depth[k][1]) + (f.depth[k][2] + f.depth[k][3]) < 0.0;
    near.plane[k] &= single | (faces & beyond);
    for (int i = 0; i < 4; ++i) {
      open[k][i] = near.plane[k] ? f.depth[k][i] : never_near;
      f.depth[k][i] += target.plane[k] ? zero : rim;
    }
  }
  V share[4][4] = {};
  press_corners(f, open, source, kappa, share, sums);
  press_edges(f, open, near, source, kappa, share, sums);
  for (int k = 0; k < 4; ++k) {
    const V whole = (share[k][0] + share[k][1]) + (share[k][2] + share[k][3]);
    if (!simd::any(whole > 0.0))
      continue;
    const VecOf<V>& n = f.normal[k];
    VecOf<V> moment{};
    for (int i = 0; i < 4; ++i) {
      moment = simd::plus(moment, simd::scaled(share[k][i], q[i]));
      on_q[i] = simd::plus(on_q[i], simd::scaled(share[k][i], n));
    }
    // Each corner of the plane takes the part that its area beside the place has of the face.
    for (int corner = 0; corner < 3; ++corner) {
      const VecOf<V> &next = p[face_of[k][(corner + 1) % 3]], &last = p[face_of[k][(corner + 2) % 3]];
      const VecOf<V> across = simd::cross(n, simd::minus(last, next));
      const V part = f.inverse[k] * simd::dot(across, simd::minus(moment, simd::scaled(whole, next)));
      on_p[face_of[k][corner]] = simd::minus(on_p[face_of[k][corner]], simd::scaled(part, n));
    }
  }
}

template <class V>
CDEM_INLINE VecOf<V> load_three(const double* values, std::int64_t first, std::int64_t count) {
  VecOf<V> v{};
  for (int lane = 0; lane < width<V>; ++lane) {
    const double* const at = values + 3 * std::min(first + lane, count - 1);
    v.x[lane] = at[0];
    v.y[lane] = at[1];
    v.z[lane] = at[2];
  }
  return v;
}

template <class V>
CDEM_INLINE void store_corners(const VecOf<V> (&force)[4], const V (&part)[4], const double sign, int at,
                               int used, TetPressure* const* out) {
  for (int k = 0; k < 4; ++k)
    for (int lane = 0; lane < used; ++lane) {
      out[lane]->force[at + k] = {force[k].x[lane], force[k].y[lane], force[k].z[lane]};
      out[lane]->part[at + k] = sign * part[k][lane];
    }
}

template <class V>
CDEM_INLINE void press_kernel(const PairsOfTets& pairs, const Node* velocity, const double* offset,
                              const TetLaw* laws, const double* shear, TetPressure* const* out) {
  for (std::int64_t i = 0; i < pairs.count; i += width<V>) {
    const int used = static_cast<int>(std::min<std::int64_t>(width<V>, pairs.count - i));
    VecOf<V> a[4], b[4];
    gather_pair(pairs, i, a, b);
    V off{}, kappa{}, ks{}, tan_friction{}, step{}, rim{}, damping{}, damping_ratio{};
    for (int lane = 0; lane < width<V>; ++lane) {
      const std::int64_t at = std::min(i + lane, pairs.count - 1);
      off[lane] = offset[at];
      kappa[lane] = laws[at].kappa;
      ks[lane] = laws[at].ks;
      tan_friction[lane] = laws[at].tan_friction;
      step[lane] = laws[at].step;
      rim[lane] = laws[at].rim;
      damping[lane] = laws[at].damping;
      damping_ratio[lane] = laws[at].damping_ratio;
    }
    VecOf<V> on_a[4] = {}, on_b[4] = {};
    PressureSums<V> sums;
    const PairsAtOnce<V> at_once = several<V>(pairs, i);
    const Open<V> open_a = open_planes<V>(pairs, at_once.a), open_b = open_planes<V>(pairs, at_once.b);
    VecOf<V> normal_a[4], normal_b[4];
    for (int k = 0; k < 4; ++k) {
      normal_a[k] = unit_normal(a, k);
      normal_b[k] = unit_normal(b, k);
    }
    press_into(a, b, normal_b, open_a, open_b, rim, off, kappa, on_a, on_b, sums);
    press_into(b, a, normal_a, open_b, open_a, rim, off, kappa, on_b, on_a, sums);
    const VecOf<V> resultant = simd::plus(simd::plus(on_a[0], on_a[1]), simd::plus(on_a[2], on_a[3]));
    const V square = simd::dot(resultant, resultant), one = V{} + 1.0, zero{};
    const MaskOf<V> presses = (square > 0.0) & (sums.stored > 0.0);
    const V size = where(presses, root(square));
    const V inverse = where(presses, 1.0 / (presses ? size : one));
    const VecOf<V> n = simd::scaled(inverse, resultant);
    V part_a[4], part_b[4];
    for (int k = 0; k < 4; ++k) {
      part_a[k] = inverse * simd::dot(on_a[k], n);
      part_b[k] = inverse * simd::dot(on_b[k], n);
    }
    VecOf<V> t = load_three<V>(shear, i, pairs.count);
    V friction{}, damped{}, work{}, tolerance{};
    if (velocity) {
      VecOf<V> v[8], past{};
      {
        VecOf<V> of_a[4], of_b[4];
        gather_corners(velocity, at_once.a, of_a);
        gather_corners(velocity, at_once.b, of_b);
        for (int k = 0; k < 4; ++k) {
          v[k] = of_a[k];
          v[4 + k] = of_b[k];
        }
      }
      VecOf<V> mean{};
      for (int k = 0; k < 8; ++k)
        mean = simd::plus(mean, v[k]);
      mean = simd::scaled(V{} + 0.125, mean);
      V fastest2{};
      for (int k = 0; k < 8; ++k) {
        past = simd::plus(past, simd::scaled(k < 4 ? part_a[k % 4] : part_b[k % 4], v[k]));
        work += simd::dot(k < 4 ? on_a[k % 4] : on_b[k % 4], v[k]);
        const VecOf<V> own = simd::minus(v[k], mean);
        fastest2 = larger(fastest2, simd::dot(own, own));
      }
      work = step * work;
      tolerance = (4.0 * sums.stiffness) * (step * step) * fastest2;
      const V approach = zero - simd::dot(past, n), most = damping_ratio * size;
      const V extra = where(presses, larger(zero - most, smaller(most, damping * approach)));
      damped = step * extra * approach;
      const V more = extra * inverse;
      for (int k = 0; k < 4; ++k) {
        on_a[k] = simd::plus(on_a[k], simd::scaled(more, on_a[k]));
        on_b[k] = simd::plus(on_b[k], simd::scaled(more, on_b[k]));
      }
      const VecOf<V> slip = simd::scaled(step, simd::minus(past, simd::scaled(simd::dot(past, n), n)));
      const VecOf<V> had_before = t;
      const V had = simd::dot(t, t);
      t = simd::minus(t, simd::scaled(simd::dot(t, n), n));
      VecOf<V> trial = simd::minus(t, simd::scaled(ks, slip));
      const V trial2 = simd::dot(trial, trial), limit = tan_friction * size;
      const MaskOf<V> slides = trial2 > limit * limit;
      const V held = slides ? limit / root(slides ? trial2 : one) : one;
      trial = simd::scaled(where(presses, held), trial);
      // The work on the spring, less what it stores more.
      const V work = -0.5 * simd::dot(simd::plus(t, trial), slip);
      const V gain = 0.5 * (simd::dot(trial, trial) - had) / (ks > 0.0 ? ks : one);
      const MaskOf<V> moved = step != 0.0;
      friction = where((ks > 0.0) & moved, work - gain);
      t = {moved ? trial.x : had_before.x, moved ? trial.y : had_before.y, moved ? trial.z : had_before.z};
    }
    for (int k = 0; k < 4; ++k) {
      on_a[k] = simd::plus(on_a[k], simd::scaled(part_a[k], t));
      on_b[k] = simd::plus(on_b[k], simd::scaled(part_b[k], t));
    }
    store_corners(on_a, part_a, 1, 0, used, out + i);
    store_corners(on_b, part_b, -1, 4, used, out + i);
    for (int lane = 0; lane < used; ++lane) {
      TetPressure& to = *out[i + lane];
      to.shear = {t.x[lane], t.y[lane], t.z[lane]};
      to.normal = {n.x[lane], n.y[lane], n.z[lane]};
      to.pressing = size[lane];
      to.stored = sums.stored[lane];
      to.stiffness = sums.stiffness[lane];
      to.depth = sums.depth[lane];
      to.friction = friction[lane];
      to.damping = damped[lane];
      to.work = work[lane];
      to.tolerance = tolerance[lane];
    }
  }
}

} // namespace

void parted_by_planes(const PairsOfTets& pairs, double* gap) {
  simd::best_width<planes_kernel<simd::Oct>, planes_kernel<simd::Quad>>(pairs, gap);
}

void deepest_in_each_other(const PairsOfTets& pairs, const double* offset, double* phi) {
  simd::best_width<deepest_kernel<simd::Oct>, deepest_kernel<simd::Quad>>(pairs, offset, phi);
}

void press(const PairsOfTets& pairs, const Node* velocity, const double* offset, const TetLaw* laws,
           const double* shear, TetPressure* const* out) {
  simd::best_width<press_kernel<simd::Oct>, press_kernel<simd::Quad>>(pairs, velocity, offset, laws, shear, out);
}

} // namespace cdem
