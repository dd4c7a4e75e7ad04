#include "libcdem/bond/idle_springs.hpp"

#include "libcdem/bond/bond_work.hpp"
#include "libcdem/bond/spring_forces.hpp"

#include <algorithm>

namespace cdem {
namespace {

bool is_idle(const State& state, const Interface& interface) {
  if (!released(state, interface))
    return false;
  const auto presses = [&](int p) { return !state.water_pressure.empty() && state.water_pressure[p] > 0; };
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    if (presses(p))
      return false;
  return true;
}

} // namespace

void find_idle_springs(const Model& model, const State& state, BondWork& work) {
  if (model.frames.empty())
    return;
  IdleSprings& idle = work.idle;
  std::vector<char> of_interface;
  idle.block.assign(model.blocks.size(), 1);
  for (const Interface& interface : model.interfaces) {
    const bool none_acts = is_idle(state, interface);
    of_interface.push_back(static_cast<char>(none_acts));
    if (!none_acts) {
      idle.block[interface.block_a] = idle.block[interface.block_b] = 0;
      continue;
    }
    for (int p = interface.point_begin; p < interface.point_end; ++p) {
      work.spring_force[p].setZero();
      work.acting_force[p].setZero();
    }
  }
  idle.batch.clear();
  for (const SpringBatch& batch : work.batches.springs)
    idle.batch.push_back(
        static_cast<char>(std::all_of(batch.interface, batch.interface + batch.count,
                                      [&](int interface) { return of_interface[interface]; })));
}

} // namespace cdem
