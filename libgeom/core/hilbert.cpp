#include "libgeom/core/hilbert.hpp"

#include <algorithm>

namespace geom {
namespace {

constexpr int bits = 21; // of each axis; three fit into 64

} // namespace

std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  // Skilling's AxesToTranspose: undo the turns of the sub-cubes from the largest to the smallest, then Gray
  // code.
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t low = q - 1;
    for (std::uint32_t& axis : x)
      if ((axis & q) != 0)
        x[0] ^= low;
      else {
        const std::uint32_t swapped = (x[0] ^ axis) & low;
        x[0] ^= swapped;
        axis ^= swapped;
      }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turned = 0;
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1)
    if ((x[2] & q) != 0)
      turned ^= q - 1;
  std::uint64_t index = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (const std::uint32_t axis : x)
      index = index << 1 | (((axis ^ turned) >> bit) & 1U);
  return index;
}

std::vector<int> along_hilbert_curve(const std::vector<Vec3>& places, const Box& box) {
  constexpr double cells = 1U << bits;
  const double size = places.empty() ? 0 : box.size().maxCoeff();
  const double scale = size > 0 ? cells / size : 0;
  std::vector<std::pair<std::uint64_t, int>> keys;
  keys.reserve(places.size());
  for (const Vec3& place : places) {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      cell[i] = static_cast<std::uint32_t>(std::clamp((place[axis] - box.min[axis]) * scale, 0., cells - 1));
    }
    keys.emplace_back(hilbert_index(cell), static_cast<int>(keys.size()));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order;
  order.reserve(keys.size());
  for (const auto& [key, place] : keys)
    order.push_back(place);
  return order;
}

} // namespace geom
