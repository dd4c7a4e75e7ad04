#include "libcdem/results/tet_at_place.hpp"

#include "libcdem/model/known_of_model.hpp"
#include "libcdem/model/unit_order.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Weights down to this count as inside: places on faces belong to the tets on both sides.
constexpr double outside = -1e-6;

// m: grown by what `outside` allows.
geom::Box box_of_tet(const Model& model, int tet) {
  geom::Box box;
  for (const int node : model.tets[tet])
    box.extend(model.node_position[node]);
  const geom::Vec3 more = 1e-5 * (box.max - box.min) + geom::Vec3::Constant(1e-12 * model.length);
  return {box.min - more, box.max + more};
}

std::optional<PlaceInTet> inside(const Model& model, int block, int tet, const geom::Vec3& place) {
  const geom::Tet& nodes = model.tets[tet];
  const auto& x = model.node_position;
  geom::Mat3 edges;
  edges << x[nodes[1]] - x[nodes[0]], x[nodes[2]] - x[nodes[0]], x[nodes[3]] - x[nodes[0]];
  const geom::Vec3 w = edges.inverse() * (place - x[nodes[0]]);
  const double w0 = 1 - w.sum();
  if (std::min(w0, w.minCoeff()) < outside)
    return std::nullopt;
  return PlaceInTet{block, tet, {w0, w[0], w[1], w[2]}};
}

} // namespace

TetsByPlace::TetsByPlace(const Model& model) {
  geom::Box all;
  for (const geom::Vec3& x : model.node_position)
    all.extend(x);
  if (model.tets.empty()) {
    begin_.assign(2, 0);
    return;
  }
  const geom::Vec3 extent = (all.max - all.min).cwiseMax(1e-9 * model.length);
  // As many boxes as tets, cubes where the model allows it.
  const double edge = std::cbrt(extent.prod() / static_cast<double>(model.tets.size()));
  constexpr double most = 400; // along an axis
  for (int axis = 0; axis < 3; ++axis) {
    count_[axis] = static_cast<int>(std::clamp(std::floor(extent[axis] / edge), 1.0, most));
    size_[axis] = extent[axis] / count_[axis];
  }
  from_ = all.min;
  begin_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
  const auto each = [&](const auto& tell) { // tell(box, tet)
    for (const int b : blocks_by_id(model))
      for (int t = model.blocks[b].tet_begin; t < model.blocks[b].tet_end; ++t) {
        const geom::Box box = box_of_tet(model, t);
        std::array<int, 3> low{}, high{}, at{};
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] = box_of(box.min[axis], axis);
          high[axis] = box_of(box.max[axis], axis);
        }
        for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
          for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
            for (at[2] = low[2]; at[2] <= high[2]; ++at[2])
              tell(number(at), t);
      }
  };
  each([&](std::size_t box, int) { ++begin_[box + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i)
    begin_[i] += begin_[i - 1];
  tets_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<std::int64_t> next(begin_.begin(), begin_.end() - 1);
  each([&](std::size_t box, int tet) { tets_[static_cast<std::size_t>(next[box]++)] = tet; });
}

int TetsByPlace::box_of(double x, int axis) const {
  const double at = std::floor((x - from_[axis]) / size_[axis]);
  return static_cast<int>(std::clamp(at, 0.0, count_[axis] - 1.0));
}

std::size_t TetsByPlace::number(const std::array<int, 3>& box) const {
  return (static_cast<std::size_t>(box[0]) * count_[1] + box[1]) * count_[2] + box[2];
}

template <class Looked>
std::optional<PlaceInTet> TetsByPlace::find_of(const Model& model, const geom::Vec3& place,
                                               const Looked& looked) const {
  if (!place.allFinite())
    return std::nullopt;
  const std::size_t box = number({box_of(place.x(), 0), box_of(place.y(), 1), box_of(place.z(), 2)});
  for (std::int64_t i = begin_[box]; i < begin_[box + 1]; ++i) {
    const int tet = tets_[static_cast<std::size_t>(i)], block = model.tet_block[tet];
    if (!looked(block))
      continue;
    if (auto found = inside(model, block, tet, place))
      return found;
  }
  return std::nullopt;
}

std::optional<PlaceInTet> TetsByPlace::find(const Model& model, const geom::Vec3& place) const {
  return find_of(model, place, [](int) { return true; });
}

std::optional<PlaceInTet> TetsByPlace::find_beside(const Model& model, const geom::Vec3& place,
                                                   int body) const {
  return find_of(model, place, [&](int block) { return model.blocks[block].body != body; });
}

std::shared_ptr<const TetsByPlace> tets_by_place(const Model& model) {
  static KnownOfModel<TetsByPlace> known;
  return known.of(model, [&] { return TetsByPlace(model); });
}

} // namespace cdem
