#include "libcdem/contact/pairs/tet_pressure.hpp"

#include "libcdem/parallel/simd.hpp"
#include "libgeom/core/types.hpp"

#include "libcdem/parallel/triple.hpp"

#include <algorithm>

namespace cdem {
namespace {

using simd::Mask;
using simd::Oct;
using simd::Vec;

constexpr int face_of[4][3] = {
    {1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; // by the corner opposite, seen from outside
constexpr int edge_of[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr double far_off = 1e300;

CDEM_INLINE Oct smaller(const Oct& a, const Oct& b) {
  return a < b ? a : b;
}
CDEM_INLINE Oct larger(const Oct& a, const Oct& b) {
  return a > b ? a : b;
}
CDEM_INLINE Oct least_of(const Oct (&v)[4]) {
  return smaller(smaller(v[0], v[1]), smaller(v[2], v[3]));
}
CDEM_INLINE Oct where(const Mask& mask, const Oct& v) {
  const Oct zero{};
  return mask ? v : zero;
}

// Eight pairs from the i-th on; lanes behind the last one repeat it.
struct EightPairs {
  std::int32_t a[lanes], b[lanes];
};

CDEM_INLINE EightPairs eight(const PairsOfTets& pairs, std::int64_t first) {
  EightPairs of;
  for (int lane = 0; lane < lanes; ++lane) {
    const std::int64_t i = first + lane < pairs.count ? first + lane : pairs.count - 1;
    of.a[lane] = pairs.a[pairs.row[i]];
    of.b[lane] = pairs.b[pairs.row[i]];
  }
  return of;
}

CDEM_INLINE void gather_corners(const Node* at, const std::int32_t (&tet)[lanes], Vec (&x)[4]) {
  for (int k = 0; k < 4; ++k) {
    std::int32_t index[lanes];
    for (int lane = 0; lane < lanes; ++lane)
      index[lane] = 4 * tet[lane] + k;
    x[k] = simd::gather(at, index);
  }
}

// Seen from the first corner of a.
CDEM_INLINE void gather_pair(const PairsOfTets& pairs, std::int64_t first, Vec (&a)[4], Vec (&b)[4]) {
  const EightPairs of = eight(pairs, first);
  gather_corners(pairs.place, of.a, a);
  gather_corners(pairs.place, of.b, b);
  const Vec origin = a[0];
  for (int k = 0; k < 4; ++k) {
    a[k] = simd::minus(a[k], origin);
    b[k] = simd::minus(b[k], origin);
  }
}

CDEM_INLINE Vec normal_of(const Vec (&x)[4], int k) {
  const Vec& foot = x[face_of[k][0]];
  return simd::cross(simd::minus(x[face_of[k][1]], foot), simd::minus(x[face_of[k][2]], foot));
}

// How much one of the planes of p parts q from it.
CDEM_INLINE Oct parted(const Vec (&p)[4], const Vec (&q)[4]) {
  Oct best = Oct{} - far_off;
  for (int k = 0; k < 4; ++k) {
    const Vec n = normal_of(p, k);
    const Oct level = simd::dot(n, p[face_of[k][0]]);
    const Oct height[4] = {simd::dot(n, q[0]) - level, simd::dot(n, q[1]) - level, simd::dot(n, q[2]) - level,
                           simd::dot(n, q[3]) - level};
    best = larger(best, least_of(height) / root(simd::dot(n, n)));
  }
  return best;
}

CDEM_INLINE void planes_kernel(const PairsOfTets& pairs, double* gap) {
  for (std::int64_t i = 0; i < pairs.count; i += lanes) {
    Vec a[4], b[4];
    gather_pair(pairs, i, a, b);
    const Oct most = larger(parted(a, b), parted(b, a));
    for (int lane = 0; lane < lanes && i + lane < pairs.count; ++lane)
      gap[i + lane] = most[lane];
  }
}

// Of the corners of q in the field of p.
struct Field {
  Vec normal[4];   // unit, outwards
  Oct inverse[4];  // 1/m2, over twice the areas
  Oct depth[4][4]; // m, D_k of each corner
};

CDEM_INLINE Field field_of(const Vec (&p)[4], const Vec (&q)[4], const Oct& offset) {
  Field f;
  for (int k = 0; k < 4; ++k) {
    const Vec n = normal_of(p, k);
    f.inverse[k] = 1.0 / root(simd::dot(n, n));
    f.normal[k] = simd::scaled(f.inverse[k], n);
    const Oct level = simd::dot(f.normal[k], p[face_of[k][0]]) - offset;
    for (int i = 0; i < 4; ++i)
      f.depth[k][i] = level - simd::dot(f.normal[k], q[i]);
  }
  return f;
}

// Along an edge phi is the least of four linear functions. Its largest value is that of two of them alone, since one place and
// one value are sought: at an end, or where the two are equal.
CDEM_INLINE Oct largest_phi(const Field& f) {
  const Oct one = Oct{} + 1.0;
  Oct best = Oct{} - far_off;
  for (int i = 0; i < 4; ++i) {
    const Oct here[4] = {f.depth[0][i], f.depth[1][i], f.depth[2][i], f.depth[3][i]};
    best = larger(best, least_of(here));
  }
  for (const auto& [i, j] : edge_of) {
    Oct most = Oct{} + far_off;
    for (int k = 0; k < 4; ++k)
      most = smaller(most, larger(f.depth[k][i], f.depth[k][j]));
    if (!simd::any(most > best))
      continue;
    for (int k = 0; k < 4; ++k)
      for (int l = k + 1; l < 4; ++l) {
        const Oct at_i = f.depth[l][i] - f.depth[k][i], at_j = f.depth[l][j] - f.depth[k][j];
        const Mask meet = (at_i < 0.0) != (at_j < 0.0);
        const Oct t = at_i / (meet ? at_i - at_j : one);
        const Oct ends = larger(smaller(f.depth[k][i], f.depth[l][i]), smaller(f.depth[k][j], f.depth[l][j]));
        const Oct there = f.depth[k][i] + t * (f.depth[k][j] - f.depth[k][i]);
        most = smaller(most, meet ? larger(ends, there) : ends);
      }
    best = larger(best, most);
  }
  return best;
}

CDEM_INLINE void deepest_kernel(const PairsOfTets& pairs, const double* offset, double* phi) {
  for (std::int64_t i = 0; i < pairs.count; i += lanes) {
    Vec a[4], b[4];
    gather_pair(pairs, i, a, b);
    Oct off{};
    for (int lane = 0; lane < lanes; ++lane)
      off[lane] = offset[std::min(i + lane, pairs.count - 1)];
    const Oct most = larger(largest_phi(field_of(a, b, off)), largest_phi(field_of(b, a, off)));
    for (int lane = 0; lane < lanes && i + lane < pairs.count; ++lane)
      phi[i + lane] = most[lane];
  }
}

struct PressureSums {
  Oct stored{}, stiffness{}, depth{};
};

// The part of an edge on which phi is D_k > 0.
struct Stretch {
  Oct from, to;
};

// Cuts it to where a linear function with these values at the ends of the edge is not below 0.
CDEM_INLINE void cut(Stretch& s, const Oct& at_i, const Oct& at_j) {
  const Oct one = Oct{} + 1.0, zero{}, never = Oct{} + 2.0;
  const Oct t = at_i / (at_i == at_j ? one : at_i - at_j);
  const Mask below_i = at_i < 0.0, below_j = at_j < 0.0;
  s.from = larger(s.from, below_i ? (below_j ? never : t) : zero);
  s.to = smaller(s.to, below_j ? t : one);
}

// share[k][i]: N, of what presses on plane k the part at corner i of q.
CDEM_INLINE void press_corners(const Field& f, const Oct& kappa, Oct (&share)[4][4], PressureSums& sums) {
  for (int i = 0; i < 4; ++i) {
    const Oct here[4] = {f.depth[0][i], f.depth[1][i], f.depth[2][i], f.depth[3][i]};
    const Oct phi = least_of(here);
    const Mask in = phi > 0.0;
    if (!simd::any(in))
      continue;
    const Oct force = where(in, kappa * phi);
    sums.stored += 0.5 * force * phi;
    sums.stiffness += where(in, kappa);
    sums.depth = larger(sums.depth, phi);
    Mask taken{};
    for (int k = 0; k < 4; ++k) {
      const Mask is = (here[k] == phi) & ~taken;
      taken |= is;
      share[k][i] += where(is, force);
    }
  }
}

CDEM_INLINE void press_edges(const Field& f, const Oct& kappa, Oct (&share)[4][4], PressureSums& sums) {
  for (const auto& [i, j] : edge_of) {
    Mask out{};
    for (int k = 0; k < 4; ++k)
      out |= (f.depth[k][i] <= 0.0) & (f.depth[k][j] <= 0.0);
    if (!simd::any(~out))
      continue;
    Stretch inside{Oct{}, Oct{} + 1.0};
    for (int k = 0; k < 4; ++k)
      cut(inside, f.depth[k][i], f.depth[k][j]);
    if (!simd::any((inside.to > inside.from) & ~out))
      continue;
    Stretch of[4] = {inside, inside, inside, inside};
    for (int k = 0; k < 4; ++k)
      for (int l = k + 1; l < 4; ++l) {
        const Oct at_i = f.depth[l][i] - f.depth[k][i], at_j = f.depth[l][j] - f.depth[k][j];
        const Oct one = Oct{} + 1.0, zero{}, never = Oct{} + 2.0;
        const Oct t =
            at_i / (at_i == at_j ? one : at_i - at_j); // k is nearer where the difference is above 0
        const Mask below_i = at_i < 0.0, below_j = at_j < 0.0;
        of[k].from = larger(of[k].from, below_i ? (below_j ? never : t) : zero);
        of[k].to = smaller(of[k].to, below_j ? t : one);
        of[l].from = larger(of[l].from, below_i ? zero : (below_j ? t : never));
        of[l].to = smaller(of[l].to, below_j ? one : t);
      }
    for (int k = 0; k < 4; ++k) {
      const Mask acts = (of[k].to > of[k].from) & ~out;
      if (!simd::any(acts))
        continue;
      const Oct from = of[k].from, to = acts ? of[k].to : from, width = to - from;
      const Oct slope = f.depth[k][j] - f.depth[k][i];
      const Oct first = f.depth[k][i] + slope * from, last = f.depth[k][i] + slope * to;
      const Oct sum = 0.5 * width * (first + last),
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

// What the corners and edges of q do in the field of p.
CDEM_INLINE void press_into(const Vec (&p)[4], const Vec (&q)[4], const Oct& offset, const Oct& kappa,
                            Vec (&on_p)[4], Vec (&on_q)[4], PressureSums& sums) {
  const Field f = field_of(p, q, offset);
  Oct share[4][4] = {};
  press_corners(f, kappa, share, sums);
  press_edges(f, kappa, share, sums);
  for (int k = 0; k < 4; ++k) {
    const Oct whole = (share[k][0] + share[k][1]) + (share[k][2] + share[k][3]);
    if (!simd::any(whole > 0.0))
      continue;
    const Vec& n = f.normal[k];
    Vec moment{};
    for (int i = 0; i < 4; ++i) {
      moment = simd::plus(moment, simd::scaled(share[k][i], q[i]));
      on_q[i] = simd::plus(on_q[i], simd::scaled(share[k][i], n));
    }
    // Each corner of the plane takes the part that its area beside the place has of the face.
    for (int corner = 0; corner < 3; ++corner) {
      const Vec &next = p[face_of[k][(corner + 1) % 3]], &last = p[face_of[k][(corner + 2) % 3]];
      const Vec across = simd::cross(n, simd::minus(last, next));
      const Oct part = f.inverse[k] * simd::dot(across, simd::minus(moment, simd::scaled(whole, next)));
      on_p[face_of[k][corner]] = simd::minus(on_p[face_of[k][corner]], simd::scaled(part, n));
    }
  }
}

CDEM_INLINE Vec load_three(const double* values, std::int64_t first, std::int64_t count) {
  Vec v{};
  for (int lane = 0; lane < lanes; ++lane) {
    const double* const at = values + 3 * std::min(first + lane, count - 1);
    v.x[lane] = at[0];
    v.y[lane] = at[1];
    v.z[lane] = at[2];
  }
  return v;
}

CDEM_INLINE void store_corners(const Vec (&force)[4], const Oct (&part)[4], const double sign, int at,
                               int used, TetPressure* const* out) {
  for (int k = 0; k < 4; ++k)
    for (int lane = 0; lane < used; ++lane) {
      out[lane]->force[at + k] = {force[k].x[lane], force[k].y[lane], force[k].z[lane]};
      out[lane]->part[at + k] = sign * part[k][lane];
    }
}

CDEM_INLINE void press_kernel(const PairsOfTets& pairs, const Node* velocity, const double* offset,
                              const TetLaw* laws, const double* shear, TetPressure* const* out) {
  for (std::int64_t i = 0; i < pairs.count; i += lanes) {
    const int used = static_cast<int>(std::min<std::int64_t>(lanes, pairs.count - i));
    Vec a[4], b[4];
    gather_pair(pairs, i, a, b);
    Oct off{}, kappa{}, ks{}, tan_friction{}, step{};
    for (int lane = 0; lane < lanes; ++lane) {
      const std::int64_t at = std::min(i + lane, pairs.count - 1);
      off[lane] = offset[at];
      kappa[lane] = laws[at].kappa;
      ks[lane] = laws[at].ks;
      tan_friction[lane] = laws[at].tan_friction;
      step[lane] = laws[at].step;
    }
    Vec on_a[4] = {}, on_b[4] = {};
    PressureSums sums;
    press_into(a, b, off, kappa, on_a, on_b, sums);
    press_into(b, a, off, kappa, on_b, on_a, sums);
    const Vec resultant = simd::plus(simd::plus(on_a[0], on_a[1]), simd::plus(on_a[2], on_a[3]));
    const Oct square = simd::dot(resultant, resultant), one = Oct{} + 1.0;
    const Mask presses = (square > 0.0) & (sums.stored > 0.0);
    const Oct size = where(presses, root(square));
    const Oct inverse = where(presses, 1.0 / (presses ? size : one));
    const Vec n = simd::scaled(inverse, resultant);
    Oct part_a[4], part_b[4];
    for (int k = 0; k < 4; ++k) {
      part_a[k] = inverse * simd::dot(on_a[k], n);
      part_b[k] = inverse * simd::dot(on_b[k], n);
    }
    Vec t = load_three(shear, i, pairs.count);
    Oct friction{};
    if (velocity) {
      const EightPairs of = eight(pairs, i);
      Vec v[4], past{};
      gather_corners(velocity, of.a, v);
      for (int k = 0; k < 4; ++k)
        past = simd::plus(past, simd::scaled(part_a[k], v[k]));
      gather_corners(velocity, of.b, v);
      for (int k = 0; k < 4; ++k)
        past = simd::plus(past, simd::scaled(part_b[k], v[k]));
      const Vec slip = simd::scaled(step, simd::minus(past, simd::scaled(simd::dot(past, n), n)));
      const Vec had_before = t;
      const Oct had = simd::dot(t, t);
      t = simd::minus(t, simd::scaled(simd::dot(t, n), n));
      Vec trial = simd::minus(t, simd::scaled(ks, slip));
      const Oct trial2 = simd::dot(trial, trial), limit = tan_friction * size;
      const Mask slides = trial2 > limit * limit;
      const Oct held = slides ? limit / root(slides ? trial2 : one) : one;
      trial = simd::scaled(where(presses, held), trial);
      // The work on the spring, less what it stores more.
      const Oct work = -0.5 * simd::dot(simd::plus(t, trial), slip);
      const Oct gain = 0.5 * (simd::dot(trial, trial) - had) / (ks > 0.0 ? ks : one);
      const Mask moved = step != 0.0;
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
    }
  }
}

} // namespace

void parted_by_planes(const PairsOfTets& pairs, double* gap) {
  simd::best<planes_kernel>(pairs, gap);
}

void deepest_in_each_other(const PairsOfTets& pairs, const double* offset, double* phi) {
  simd::best<deepest_kernel>(pairs, offset, phi);
}

void press(const PairsOfTets& pairs, const Node* velocity, const double* offset, const TetLaw* laws,
           const double* shear, TetPressure* const* out) {
  simd::best<press_kernel>(pairs, velocity, offset, laws, shear, out);
}

} // namespace cdem
