#include "libcdem/results/watch.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libcdem/results/units.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdem {
namespace {

std::vector<geom::Vec3> centroids(const Model& model, const State& state) {
  std::vector<geom::Vec3> places;
  places.reserve(model.blocks.size());
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
    places.push_back(model.blocks[b].mass.centroid + mean_displacement(model, state, b));
  return places;
}

// By each block, ascending.
std::vector<std::vector<int>> touching(const Model& model, const State& state) {
  std::vector<std::vector<int>> touched(model.blocks.size());
  for (const Contact& contact : state.contacts) {
    const auto [a, b] = blocks_of(model, contact);
    if (a == b)
      continue;
    touched[a].push_back(b);
    touched[b].push_back(a);
  }
  for (std::vector<int>& list : touched) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return touched;
}

bool can_break(const Model& model, int block) {
  return !model.bodies[model.blocks[block].body].bonding.none();
}

geom::Vec3 centroid_now(const Model& model, const State& state, int tet) {
  geom::Vec3 sum = geom::Vec3::Zero();
  for (const int node : model.tets[tet])
    sum += place_of(model, state, node);
  return sum / 4;
}

// Pieces smaller than this part of their unit are crumbs.
constexpr double least_share = 0.05;

// The remains of a unit, piece by piece.
struct Piece {
  double volume = 0;                     // m3
  geom::Vec3 moved = geom::Vec3::Zero(); // m, times volume, since the watch was made
  geom::Vec3 place = geom::Vec3::Zero(); // m, times volume
  std::vector<int> tets;
};

// By the smallest node of each. first: of the block's tets in the watch.
std::map<int, Piece> pieces(const Model& model, const State& state, const Watch& watch, int block,
                            std::size_t first, const std::vector<int>& fragment) {
  std::map<int, Piece> found;
  for (int t = model.blocks[block].tet_begin; t < model.blocks[block].tet_end; ++t) {
    const std::size_t place = first + static_cast<std::size_t>(t - model.blocks[block].tet_begin);
    if (watch.tet_left[place] >= 0)
      continue;
    Piece& piece = found[fragment[model.tets[t][0]]];
    const double volume = tet_volume(model, t);
    const geom::Vec3 now = centroid_now(model, state, t);
    piece.volume += volume;
    piece.moved += volume * (now - watch.tet_start[place]);
    piece.place += volume * now;
    piece.tets.push_back(t);
  }
  return found;
}

} // namespace

Watch start_watch(const Model& model, const State& state, const std::string& body, double leaves) {
  geom::require_above("leaves", leaves, 0, "m", "half the height of a unit is usual");
  Watch watch;
  watch.leaves = leaves;
  watch.blocks = units_of_body(model, body);
  for (const int b : watch.blocks)
    if (!model.blocks[b].meshed)
      throw geom::InputError("body", "\"" + body + "\"", "a body of meshes",
                             "blocks that can be cut are not watched");
  if (watch.blocks.empty())
    refuse_body("body", body, model);
  const std::vector<std::vector<int>> touched = touching(model, state);
  for (const int b : watch.blocks) {
    watch.numbers.push_back(model.blocks[b].unit);
    watch.touched.push_back(touched[b]);
  }
  watch.start = centroids(model, state);
  watch.gone.assign(model.blocks.size(), 0);
  for (const int b : watch.blocks)
    if (can_break(model, b))
      for (int t = model.blocks[b].tet_begin; t < model.blocks[b].tet_end; ++t)
        watch.tet_start.push_back(centroid_now(model, state, t));
  watch.tet_left.assign(watch.tet_start.size(), -1);
  return watch;
}

void look(const Model& model, const State& state, double flow_velocity, Watch& watch) {
  const std::vector<geom::Vec3> now = centroids(model, state);
  const std::vector<int> fragment =
      watch.tet_start.empty() ? std::vector<int>{} : fragments_of_nodes(model, state);
  std::vector<int> leaving;
  std::size_t tets = 0; // of the units before, of those that can break
  for (std::size_t unit = 0; unit < watch.blocks.size(); ++unit) {
    const int block = watch.blocks[unit];
    const std::size_t first = tets;
    if (can_break(model, block))
      tets += static_cast<std::size_t>(model.blocks[block].tet_end - model.blocks[block].tet_begin);
    if (watch.gone[block])
      continue;
    geom::Vec3 mean = geom::Vec3::Zero();
    int count = 0;
    for (const int other : watch.touched[unit])
      if (!watch.gone[other]) {
        mean += now[other] - watch.start[other];
        ++count;
      }
    if (count > 0)
      mean /= count;
    const auto has_left = [&](const geom::Vec3& own) { // one that stands still has been left
      return own.norm() >= watch.leaves && (own - mean).norm() >= watch.leaves;
    };
    const auto depart = [&](const geom::Vec3& own, const geom::Vec3& place, double share) {
      watch.left.push_back(
          {watch.numbers[unit], state.step, state.time, flow_velocity, own - mean, place, share});
    };
    if (!can_break(model, block)) {
      const geom::Vec3 own = now[block] - watch.start[block];
      if (!has_left(own))
        continue;
      depart(own, now[block], 1);
      leaving.push_back(block);
      continue;
    }
    double whole = 0, stays = 0;
    for (int t = model.blocks[block].tet_begin; t < model.blocks[block].tet_end; ++t)
      whole += tet_volume(model, t);
    for (const auto& [node, piece] : pieces(model, state, watch, block, first, fragment)) {
      const geom::Vec3 own = piece.moved / piece.volume;
      if (piece.volume < least_share * whole || !has_left(own)) {
        stays += piece.volume;
        continue;
      }
      const double share = piece.volume / whole;
      depart(own, piece.place / piece.volume, share > 1 - 1e-9 ? 1 : share);
      for (const int t : piece.tets)
        watch.tet_left[first + static_cast<std::size_t>(t - model.blocks[block].tet_begin)] = state.step;
    }
    if (stays < least_share * whole)
      leaving.push_back(block);
  }
  for (const int block : leaving)
    watch.gone[block] = 1;
}

Watch watch_at(const Watch& watch, std::int64_t step) {
  Watch then = watch;
  while (!then.left.empty() && then.left.back().step > step) {
    const auto number = std::find(then.numbers.begin(), then.numbers.end(), then.left.back().unit);
    then.gone[then.blocks[number - then.numbers.begin()]] = 0;
    then.left.pop_back();
  }
  for (std::int64_t& left : then.tet_left)
    if (left > step)
      left = -1;
  return then;
}

} // namespace cdem
