#include "libcdem/load/excavation.hpp"

#include "libcdem/state/places.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdem {

void check(const Excavation& excavation) {
  geom::require(excavation.relaxed >= 0 && excavation.relaxed <= 1, "relaxed", excavation.relaxed,
                "a number from 0 to 1", "the share of the excavation's forces that goes");
  geom::require_at_least("over", excavation.over, 0, "s");
}

void add_excavations(const State& state, ResolvedConditions& r) {
  std::map<std::array<double, 4>, VaryingLoad> falling; // by how they fall
  for (const ExcavationForce& f : state.excavation) {
    const geom::Vec3 force(f.x, f.y, f.z);
    const int node = static_cast<int>(f.node);
    // One that has fallen stays among those that fall: the order of a sum must not depend on the time.
    if (f.duration == 0) {
      add(r.external[node], f.after * force);
      continue;
    }
    VaryingLoad& load = falling[{f.before, f.after, f.begin, f.duration}];
    load.forces.emplace_back(node, force);
    if (!load.amplitude)
      load.amplitude = [f](double time) { return f.share(time); };
  }
  for (auto& [how, load] : falling)
    r.varying.push_back(std::move(load));
}

void keep_forces(const std::vector<Node>& force, const Excavation& excavation, State& state) {
  for (std::size_t node = 0; node < force.size(); ++node)
    if (const Node& f = force[node]; !vec(f).isZero(0))
      state.excavation.push_back({static_cast<std::int64_t>(node), f.x, f.y, f.z, 1, 1 - excavation.relaxed,
                                  state.time, excavation.over});
}

std::size_t relax_forces(const Excavation& excavation, State& state) {
  const double left = 1 - excavation.relaxed;
  std::size_t count = 0;
  for (ExcavationForce& f : state.excavation) {
    const double now = f.share(state.time);
    if (now <= left)
      continue;
    f.before = now;
    f.after = left;
    f.begin = state.time;
    f.duration = excavation.over;
    ++count;
  }
  state.excavation.erase(
      std::remove_if(state.excavation.begin(), state.excavation.end(),
                     [&](const ExcavationForce& f) { return f.after == 0 && f.end() <= state.time; }),
      state.excavation.end());
  return count;
}

} // namespace cdem
