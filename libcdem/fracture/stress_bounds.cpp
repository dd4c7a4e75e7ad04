#include "libcdem/fracture/stress_bounds.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/strength_watch.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

CDEM_INLINE bool beyond_any(const simd::Oct (&s)[6], const UtilisationBound* bounds, int count) {
  bool any = false;
  for (int i = 0; i < count; ++i) {
    const simd::Oct coarse = bounds[i].coarsely_beyond(s);
    if (!simd::any(simd::below(simd::Oct{}, coarse)))
      continue;
    const simd::Oct fine = bounds[i].beyond(s);
    any = any || simd::any(simd::below(simd::Oct{}, fine));
  }
  return any;
}

CDEM_INLINE void near_kernel(const StressBatch* stress, const StressBatch* before, std::int64_t count,
                             const UtilisationBound* bounds, int bound_count, double harmless,
                             double steps_ahead, std::uint8_t* bits) {
  // |s + a d|^2 <= 2 |s|^2 + 2 a^2 |d|^2, and twice the part off the diagonal.
  const double of_rise = steps_ahead * steps_ahead;
  const simd::Oct most = simd::Oct{} + harmless;
  for (std::int64_t i = 0; i < count; ++i) {
    simd::Oct s[6], sum{};
    for (int c = 0; c < 6; ++c) {
      s[c] = simd::load(stress[i].component[c]);
      const simd::Oct d = before ? s[c] - simd::load(before[i].component[c]) : simd::Oct{};
      const simd::Oct part = s[c] * s[c] + of_rise * d * d;
      sum += (c < 3 ? 2.0 : 4.0) * part;
    }
    if (!simd::any(simd::below(most, sum))) {
      bits[i] = 0;
      continue;
    }
    std::uint8_t found =
        beyond_any(s, bounds, bound_count) ? NearStrength::may_crack | NearStrength::may_be_due : 0;
    if (before && found == 0) {
      for (int c = 0; c < 6; ++c)
        s[c] += steps_ahead * (s[c] - simd::load(before[i].component[c]));
      found = beyond_any(s, bounds, bound_count) ? NearStrength::may_be_due : 0;
    }
    bits[i] = found;
  }
}

// Whether some tet of each batch may have a stress of more than this norm, now or at its rate ahead. rise: Pa s, `ahead` times the
// largest modulus. |s + a d|^2 <= 2 |s|^2 + 2 a^2 |d|^2.
CDEM_INLINE void loaded_kernel(const MeshBatch* batches, const StressBatch* stress, std::int64_t count,
                               const Node* position, const Node* velocity, double harmless_norm2, double rise,
                               char* loaded) {
  const simd::Oct most = simd::Oct{} + 0.5 * harmless_norm2;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto& place = batches[i].place;
    const simd::Vec x0 = simd::gather(position, place[0]), v0 = simd::gather(velocity, place[0]);
    const simd::Vec e1 = minus(simd::gather(position, place[1]), x0),
                    e2 = minus(simd::gather(position, place[2]), x0),
                    e3 = minus(simd::gather(position, place[3]), x0);
    const simd::Vec v1 = minus(simd::gather(velocity, place[1]), v0),
                    v2 = minus(simd::gather(velocity, place[2]), v0),
                    v3 = minus(simd::gather(velocity, place[3]), v0);
    const simd::Vec c1 = cross(e2, e3), c2 = cross(e3, e1), c3 = cross(e1, e2);
    const auto along = [&](const simd::Oct& a, const simd::Oct& b, const simd::Oct& c) {
      return plus(plus(scaled(a, c1), scaled(b, c2)), scaled(c, c3));
    };
    const simd::Vec gx = along(v1.x, v2.x, v3.x), gy = along(v1.y, v2.y, v3.y), gz = along(v1.z, v2.z, v3.z);
    const simd::Oct per_volume = rise / dot(e1, c1);
    simd::Oct sum = per_volume * per_volume * (dot(gx, gx) + dot(gy, gy) + dot(gz, gz));
    for (int c = 0; c < 6; ++c) {
      const simd::Oct s = simd::load(stress[i].component[c]);
      sum += (c < 3 ? 1.0 : 2.0) * s * s;
    }
    loaded[i] = static_cast<char>(simd::any(simd::below(most, sum)));
  }
}

} // namespace

double harmless_norm2(const std::vector<UtilisationBound>& bounds) {
  const auto may = [&](double norm) {
    const double mean = norm / std::sqrt(3.0);
    const double worst[6] = {mean, mean, mean, norm / std::sqrt(2.0), 0, 0};
    return std::any_of(bounds.begin(), bounds.end(),
                       [&](const UtilisationBound& bound) { return bound.coarsely_beyond(worst) > 0; });
  };
  double low = 1e-3, high = 1e15; // Pa
  for (int i = 0; i < 12; ++i) {
    const double middle = std::sqrt(low * high);
    (may(middle) ? high : low) = middle;
  }
  return low * low;
}

void find_near(const StressBatch* stress, const StressBatch* before, std::int64_t count,
               const std::vector<UtilisationBound>& bounds, double steps_ahead, std::uint8_t* bits) {
  simd::best<near_kernel>(stress, before, count, bounds.data(), static_cast<int>(bounds.size()),
                          harmless_norm2(bounds), steps_ahead, bits);
}

std::vector<char> loaded_batches(const Model& model, const State& state, const MeshChunk& chunk,
                                 const std::vector<UtilisationBound>& bounds, double ahead) {
  std::vector<Node> position(static_cast<std::size_t>(chunk.places())), velocity(position.size());
  for (int place = 0; place < static_cast<int>(chunk.places()); ++place) {
    const int node = model.mesh.node_at(chunk, place);
    const geom::Vec3 x = place_of(model, state, node);
    position[place] = {x.x(), x.y(), x.z(), 0};
    velocity[place] = state.velocity[node];
  }
  const Elastic& rock = model.bodies[model.blocks[chunk.block].body].material;
  const double modulus = 2 * rock.shear_modulus() + 3 * std::max(0.0, rock.lame_lambda());
  std::vector<char> loaded(static_cast<std::size_t>(chunk.batches.size()));
  simd::best<loaded_kernel>(model.mesh.batches.data() + chunk.batches.begin,
                            state.stress.data() + chunk.batches.begin, chunk.batches.size(), position.data(),
                            velocity.data(), harmless_norm2(bounds), ahead * modulus, loaded.data());
  return loaded;
}

bool may_use(const std::vector<UtilisationBound>& bounds, const geom::Mat3& s) {
  const double components[6] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  return std::any_of(bounds.begin(), bounds.end(), [&](const UtilisationBound& bound) {
    return bound.coarsely_beyond(components) > 0 && bound.beyond(components) > 0;
  });
}

} // namespace cdem
