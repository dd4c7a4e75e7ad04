#include "libcdem/contact/response/tet_push.hpp"

#include "libcdem/parallel/triple.hpp"

namespace cdem {
namespace {

template <class V>
struct MovingTet {
  std::array<Triple<V>, 4> x, v; // m, m/s
  Triple<V> a, b, c;             // m, from corner 0
  V volume;                      // m3, six times its own
};

template <class V>
CDEM_INLINE MovingTet<V> moving_tet(const Node* place, const Node* velocity, const TetPairView& of, int tet,
                                    int lane) {
  MovingTet<V> t;
  for (int k = 0; k < 4; ++k) {
    const std::int32_t* const nodes = of.node[4 * tet + k] + lane;
    t.x[k] = simd::gather_wide<V>(place, nodes);
    t.v[k] = simd::gather_wide<V>(velocity, nodes);
  }
  t.a = t.x[1] - t.x[0];
  t.b = t.x[2] - t.x[0];
  t.c = t.x[3] - t.x[0];
  t.volume = dot(t.a, cross(t.b, t.c));
  return t;
}

// Weights of the corners that make up a place within it; of one outside, those that are above 0 alone.
template <class V>
CDEM_INLINE std::array<V, 4> within(const MovingTet<V>& t, const Triple<V>& place) {
  const Triple<V> p = place - t.x[0];
  const V zero{}, wa = dot(p, cross(t.b, t.c)) / t.volume, wb = dot(p, cross(t.c, t.a)) / t.volume,
                  wc = dot(p, cross(t.a, t.b)) / t.volume;
  std::array<V, 4> w = {1.0 - wa - wb - wc, wa, wb, wc};
  for (V& each : w)
    each = simd::most<V>(each, zero);
  const V sum = w[0] + w[1] + w[2] + w[3];
  for (V& each : w)
    each /= sum;
  return w;
}

template <class V>
CDEM_INLINE Triple<V> spin(const MovingTet<V>& t) { // rad/s
  const Triple<V> sum = cross(cross(t.b, t.c), t.v[1] - t.v[0]) + cross(cross(t.c, t.a), t.v[2] - t.v[0]) +
                        cross(cross(t.a, t.b), t.v[3] - t.v[0]);
  return V(0.5 / t.volume) * sum;
}

template <class V>
CDEM_INLINE void push_kernel(const Node* place, const Node* velocity, const double* mass, double step,
                             const TetPairPress* presses, TetPairPush* pushes, std::int64_t count) {
  const V zero{}, one = zero + 1.0, time = zero + step;
  for (std::int64_t i = 0; i < count; ++i)
    for (int lane = 0; lane < lanes; lane += simd::width<V>) {
      const TetPairPress& press = presses[i];
      TetPairPush& push = pushes[i];
      const std::array<MovingTet<V>, 2> tets = {moving_tet<V>(place, velocity, press.of, 0, lane),
                                                moving_tet<V>(place, velocity, press.of, 1, lane)};
      std::array<Triple<V>, 8> f;
      for (int k = 0; k < 8; ++k) {
        f[k] = {simd::load_wide<V>(press.force[k][0] + lane), simd::load_wide<V>(press.force[k][1] + lane),
                simd::load_wide<V>(press.force[k][2] + lane)};
        simd::store_wide<V>(push.length[k] + lane, root(dot(f[k], f[k])));
      }
      const Triple<V> n = {simd::load_wide<V>(push.normal[0] + lane),
                           simd::load_wide<V>(push.normal[1] + lane),
                           simd::load_wide<V>(push.normal[2] + lane)};
      const V along = dot(f[0] + f[1] + (f[2] + f[3]), n);
      const simd::MaskOf<V> presses_along = simd::below<V>(zero, along);
      const V reciprocal = 1.0 / (presses_along ? along : one);
      simd::store_wide<V>(push.force + lane, presses_along ? along : zero);
      V power{}; // W
      Triple<V> at = tets[0].x[0];
      for (int k = 0; k < 8; ++k) {
        const MovingTet<V>& t = tets[k / 4];
        power += dot(f[k], t.v[k % 4]);
        at = at + V((k < 4 ? 0.5 : -0.5) * reciprocal * dot(f[k], n)) * (t.x[k % 4] - tets[0].x[0]);
      }
      const V closing = -time * power * reciprocal;
      simd::store_wide<V>(push.closing + lane, closing);
      Triple<V> past{}; // m/s
      for (int tet = 0; tet < 2; ++tet) {
        const std::array<V, 4> w = within<V>(tets[tet], at);
        for (int k = 0; k < 4; ++k) {
          const V signed_weight = tet == 0 ? w[k] : -w[k];
          simd::store_wide<V>(push.weight[4 * tet + k] + lane, signed_weight);
          past = past + signed_weight * tets[tet].v[k];
        }
      }
      const Triple<V> slid = time * (past - dot(past, n) * n) - closing * n;
      simd::store_wide<V>(push.slid[0] + lane, slid.x);
      simd::store_wide<V>(push.slid[1] + lane, slid.y);
      simd::store_wide<V>(push.slid[2] + lane, slid.z);
      simd::store_wide<V>(push.turned + lane, 0.5 * time * dot(spin(tets[0]) + spin(tets[1]), n));
      if (!mass)
        continue;
      V compliance{};
      for (int k = 0; k < 8; ++k) {
        V m;
        for (int j = 0; j < simd::width<V>; ++j)
          m[j] = mass[press.of.node[k][lane + j]];
        compliance += dot(f[k], f[k]) / m;
      }
      simd::store_wide<V>(push.compliance + lane, compliance * reciprocal * reciprocal);
    }
}

} // namespace

void find_pushes(const Node* place, const Node* velocity, const double* mass, double step,
                 const TetPairPress* presses, TetPairPush* pushes, std::int64_t count) {
  simd::best_width<push_kernel<simd::Oct>, push_kernel<simd::Quad>>(place, velocity, mass, step, presses,
                                                                    pushes, count);
}

} // namespace cdem
