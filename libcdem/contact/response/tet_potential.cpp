#include "libcdem/contact/response/tet_potential.hpp"

namespace cdem {
namespace {

template <class V>
CDEM_INLINE TetCorners<V> corners(const Node* place, const TetPairView& of, int tet, int lane) {
  return {simd::gather_wide<V>(place, of.node[4 * tet] + lane),
          simd::gather_wide<V>(place, of.node[4 * tet + 1] + lane),
          simd::gather_wide<V>(place, of.node[4 * tet + 2] + lane),
          simd::gather_wide<V>(place, of.node[4 * tet + 3] + lane)};
}

// A plane that parts them tells of both, an edge only of its own tetrahedron.
template <class V>
CDEM_INLINE void bound_kernel(const Node* place, TetPairView* views, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i)
    for (int lane = 0; lane < lanes; lane += simd::width<V>) {
      TetPairView& view = views[i];
      const TetCorners<V> a = corners<V>(place, view, 0, lane), b = corners<V>(place, view, 1, lane);
      const DepthsInTet<V> in_a = depths_in_tet<V>(a, b), in_b = depths_in_tet<V>(b, a);
      const V by_plane = -simd::most<V>(parted_by_plane<V>(in_a), parted_by_plane<V>(in_b)),
              by_edge = simd::most<V>(no_deeper_than<V>(in_a), no_deeper_than<V>(in_b));
      simd::store_wide<V>(view.deepest + lane, simd::least<V>(by_plane, by_edge));
    }
}

template <class V>
CDEM_INLINE void deepest_kernel(const Node* place, TetPairView* views, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i)
    for (int lane = 0; lane < lanes; lane += simd::width<V>) {
      TetPairView& view = views[i];
      const TetCorners<V> a = corners<V>(place, view, 0, lane), b = corners<V>(place, view, 1, lane);
      const DepthsInTet<V> in_a = depths_in_tet<V>(a, b), in_b = depths_in_tet<V>(b, a);
      simd::store_wide<V>(view.deepest + lane,
                          simd::most<V>(deepest_in_tet<V>(in_a), deepest_in_tet<V>(in_b)));
    }
}

template <class V>
CDEM_INLINE void press_kernel(const Node* place, TetPairPress* batches, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i)
    for (int lane = 0; lane < lanes; lane += simd::width<V>) {
      TetPairPress& batch = batches[i];
      const TetCorners<V> a = corners<V>(place, batch.of, 0, lane), b = corners<V>(place, batch.of, 1, lane);
      const V phi0 = simd::load_wide<V>(batch.phi0 + lane), k = simd::load_wide<V>(batch.stiffness + lane);
      TetCorners<V> on_a{}, on_b{};
      V energy = press_into_tet<V>(a, b, phi0, k, on_a, on_b);
      energy += press_into_tet<V>(b, a, phi0, k, on_b, on_a);
      simd::store_wide<V>(batch.energy + lane, energy);
      for (int j = 0; j < 4; ++j) {
        simd::store_wide<V>(batch.force[j][0] + lane, on_a[j].x);
        simd::store_wide<V>(batch.force[j][1] + lane, on_a[j].y);
        simd::store_wide<V>(batch.force[j][2] + lane, on_a[j].z);
        simd::store_wide<V>(batch.force[4 + j][0] + lane, on_b[j].x);
        simd::store_wide<V>(batch.force[4 + j][1] + lane, on_b[j].y);
        simd::store_wide<V>(batch.force[4 + j][2] + lane, on_b[j].z);
      }
    }
}

} // namespace

void bound_deepest(const Node* place, TetPairView* views, std::int64_t count) {
  simd::best_width<bound_kernel<simd::Oct>, bound_kernel<simd::Quad>>(place, views, count);
}

void find_deepest(const Node* place, TetPairView* views, std::int64_t count) {
  simd::best_width<deepest_kernel<simd::Oct>, deepest_kernel<simd::Quad>>(place, views, count);
}

void press_pairs(const Node* place, TetPairPress* batches, std::int64_t count) {
  simd::best_width<press_kernel<simd::Oct>, press_kernel<simd::Quad>>(place, batches, count);
}

} // namespace cdem
