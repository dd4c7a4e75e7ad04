#include "libcdem/results/watch.hpp"

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/results/units.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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

} // namespace

Watch start_watch(const Model& model, const State& state, const std::string& body, double leaves) {
  if (!(leaves > 0) || !std::isfinite(leaves))
    throw geom::InputError("leaves", fmt::format("{:g}", leaves), "a finite number > 0 m",
                           "half the height of a unit is usual");
  Watch watch;
  watch.leaves = leaves;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
    if (model.bodies[model.blocks[b].body].name == body) {
      if (!model.blocks[b].meshed)
        throw geom::InputError("bodies", "\"" + body + "\"", "a body of meshes",
                               "blocks that can be cut are not watched");
      watch.blocks.push_back(b);
    }
  if (watch.blocks.empty())
    refuse_body("bodies", body, model);
  const std::vector<std::vector<int>> touched = touching(model, state);
  for (const int b : watch.blocks)
    watch.touched.push_back(touched[b]);
  watch.start = centroids(model, state);
  watch.gone.assign(model.blocks.size(), 0);
  return watch;
}

void look(const Model& model, const State& state, double flow_velocity, Watch& watch) {
  const std::vector<geom::Vec3> now = centroids(model, state);
  std::vector<int> leaving;
  for (std::size_t unit = 0; unit < watch.blocks.size(); ++unit) {
    const int block = watch.blocks[unit];
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
    const geom::Vec3 own = now[block] - watch.start[block], moved = own - mean;
    if (own.norm() < watch.leaves || moved.norm() < watch.leaves) // one that stands still has been left
      continue;
    watch.left.push_back(
        {static_cast<int>(unit) + 1, state.step, state.time, flow_velocity, moved, now[block]});
    leaving.push_back(block);
  }
  for (const int block : leaving)
    watch.gone[block] = 1;
}

Watch watch_at(const Watch& watch, std::int64_t step) {
  Watch then = watch;
  while (!then.left.empty() && then.left.back().step > step) {
    then.gone[then.blocks[then.left.back().unit - 1]] = 0;
    then.left.pop_back();
  }
  return then;
}

} // namespace cdem
