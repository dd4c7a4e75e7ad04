#include "libcdem/contact/broad_phase/tet_paths.hpp"

#include "libcdem/parallel/simd.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace cdem {
namespace {

template <class V>
CDEM_INLINE V longest(const std::array<Triple<V>, 4>& v, const Triple<V>& past) {
  V most2{};
  for (const Triple<V>& each : v) {
    const Triple<V> way = minus(each, past);
    const V length2 = dot(way, way);
    most2 = most2 > length2 ? most2 : length2;
  }
  V most;
  for (int lane = 0; lane < simd::width<V>; ++lane)
    most[lane] = std::sqrt(most2[lane]);
  return most;
}

using FourFloats = float __attribute__((vector_size(16)));
using EightFloats = float __attribute__((vector_size(32)));

// Adds to the sums from `first` on, and writes them as floats too unless `now` is null.
template <class V>
CDEM_INLINE void add_to(std::vector<double>& sums, std::vector<float>* now, int first, int count,
                        const V& more) {
  double* const sum = sums.data() + first;
  if (count == simd::width<V>) { // one by one takes longer than all else here
    const V all = simd::load_wide<V>(sum) + more;
    simd::store_wide<V>(sum, all);
    if (now) {
      using Floats = std::conditional_t<simd::width<V> == lanes, EightFloats, FourFloats>;
      const Floats rounded = __builtin_convertvector(all, Floats);
      std::memcpy(now->data() + first, &rounded, sizeof rounded);
    }
    return;
  }
  for (int lane = 0; lane < count; ++lane) {
    sum[lane] += more[lane];
    if (now)
      (*now)[first + lane] = static_cast<float>(sum[lane]);
  }
}

template <class V>
CDEM_INLINE void paths_kernel(const Node* velocity, const Node& frame, double step,
                              const std::array<std::vector<int>, 4>& corner, int begin, int end,
                              TetPaths& of) {
  constexpr double rounding = 1 + 1e-6;
  const V length = V{} + rounding * step, quarter = V{} + 0.25;
  const Triple<V> past{V{} + frame.x, V{} + frame.y, V{} + frame.z};
  for (int first = begin; first < end; first += simd::width<V>) {
    const int count = std::min(simd::width<V>, end - first);
    std::array<Triple<V>, 4> v;
    for (int k = 0; k < 4; ++k) {
      int nodes[simd::width<V>];
      for (int lane = 0; lane < simd::width<V>; ++lane)
        nodes[lane] = corner[k][first + std::min(lane, count - 1)];
      v[k] = simd::gather_wide<V>(velocity, nodes);
    }
    const Triple<V> middle = scaled(quarter, plus(plus(v[0], v[1]), plus(v[2], v[3])));
    const V path = length * longest<V>(v, past), swing = length * longest<V>(v, middle);
    const Triple<V> drift = scaled(V(V{} + step), minus(middle, past));
    add_to<V>(of.path, nullptr, first, count, path);
    add_to<V>(of.swing, &of.now[3], first, count, swing);
    add_to<V>(of.drift[0], &of.now[0], first, count, drift.x);
    add_to<V>(of.drift[1], &of.now[1], first, count, drift.y);
    add_to<V>(of.drift[2], &of.now[2], first, count, drift.z);
  }
}

constexpr int pairs_per_word = 64;

CDEM_INLINE void awake_pairs_kernel(const TetPaths& of, const WatchedPairs& pairs, std::uint64_t* awake) {
  constexpr float rounding = 1e-6F; // of lengths kept as floats
  const float *const x = of.now[0].data(), *const y = of.now[1].data(), *const z = of.now[2].data(),
                     *const swing = of.now[3].data();
  const auto count = static_cast<std::int64_t>(pairs.count());
  for (std::int64_t first = 0; first < count; first += pairs_per_word) {
    const auto here = static_cast<int>(std::min<std::int64_t>(pairs_per_word, count - first));
    const int *const a = pairs.a.data() + first, *const b = pairs.b.data() + first;
    const float *const then_x = pairs.then[0].data() + first, *const then_y = pairs.then[1].data() + first,
                       *const then_z = pairs.then[2].data() + first,
                       *const then = pairs.then[3].data() + first,
                       *const allowed = pairs.allowed.data() + first;
    float left[pairs_per_word];
    for (int i = 0; i < here; ++i) {
      const float dx = x[b[i]] - x[a[i]], dy = y[b[i]] - y[a[i]], dz = z[b[i]] - z[a[i]];
      const float px = dx - then_x[i], py = dy - then_y[i], pz = dz - then_z[i];
      const float swings = swing[a[i]] + swing[b[i]];
      left[i] = allowed[i] - std::sqrt(px * px + py * py + pz * pz) - (swings - then[i]) -
                rounding * (std::abs(dx) + std::abs(dy) + std::abs(dz) + swings + std::abs(x[a[i]]) +
                            std::abs(y[a[i]]) + std::abs(z[a[i]]));
    }
    std::uint64_t bits = 0;
    for (int i = 0; i < here; ++i)
      bits |= static_cast<std::uint64_t>(!(left[i] > 0)) << i;
    awake[first / pairs_per_word] = bits;
  }
}

} // namespace

void TetPaths::assign(std::size_t count) {
  for (std::vector<double>* const sum : {&path, &swing, &drift[0], &drift[1], &drift[2]})
    sum->assign(count, 0.0);
  for (std::vector<float>& sum : now)
    sum.assign(count, 0.0F);
}

void TetPaths::copy(std::size_t from, const TetPaths& before, std::size_t to) {
  path[to] = before.path[from];
  swing[to] = before.swing[from];
  for (int axis = 0; axis < 3; ++axis)
    drift[axis][to] = before.drift[axis][from];
  for (int i = 0; i < 4; ++i)
    now[i][to] = before.now[i][from];
}

void TetPaths::clear(std::size_t tet) {
  for (std::vector<double>* const sum : {&path, &swing, &drift[0], &drift[1], &drift[2]})
    (*sum)[tet] = 0;
  for (std::vector<float>& sum : now)
    sum[tet] = 0;
}

void WatchedPairs::add(const WatchedPairs& before, std::size_t place, int one, int other) {
  a.push_back(one);
  b.push_back(other);
  for (std::size_t i = 0; i < then.size(); ++i)
    then[i].push_back(before.then[i][place]);
  allowed.push_back(before.allowed[place]);
}

void WatchedPairs::clear() {
  a.clear();
  b.clear();
  for (std::vector<float>& each : then)
    each.clear();
  allowed.clear();
}

void WatchedPairs::set(std::size_t place, const TetPaths& paths, float may_go) {
  const int one = a[place], other = b[place];
  for (int axis = 0; axis < 3; ++axis)
    then[axis][place] = paths.now[axis][other] - paths.now[axis][one];
  then[3][place] = paths.now[3][one] + paths.now[3][other];
  allowed[place] = may_go;
}

void add_step(const Node* velocity, const Node& frame, double step,
              const std::array<std::vector<int>, 4>& corner, int begin, int end, TetPaths& of) {
  simd::best_width<paths_kernel<simd::Oct>, paths_kernel<simd::Quad>>(velocity, frame, step, corner, begin,
                                                                      end, of);
}

void find_awake(const TetPaths& of, const WatchedPairs& pairs, std::vector<std::uint64_t>& awake) {
  awake.resize((pairs.count() + pairs_per_word - 1) / pairs_per_word);
  simd::best<awake_pairs_kernel>(of, pairs, awake.data());
}

} // namespace cdem
