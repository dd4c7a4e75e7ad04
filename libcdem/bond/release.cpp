#include "libcdem/bond/release.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/bond/water_work.hpp"
#include "libgeom/core/disjoint_sets.hpp"

#include <algorithm>

namespace cdem {
namespace {

constexpr double parted = 1e-3;  // of the interface's size
constexpr double opened = 0.02;  // rad
constexpr double drained = 0.05; // of the interface's size

bool any_intact(const State& state, const Interface& interface) {
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    if (is_intact(state.bond_mode[p]))
      return true;
  return false;
}

// What an interface without a whole bond does next; slips: so far that it gets new springs if another one slides.
enum class Fate : char { stays, slips, slides, leaves };

Fate fate_of(const Model& model, const State& state, const Interface& interface) {
  if (interface_opening_angle(model, state.displacement.data(), interface) > opened)
    return Fate::leaves;
  const double size = model.frames[interface.frame].size;
  const geom::Mat3 back = interface_rotation(model, state.displacement.data(), interface).transpose();
  bool open = true;
  double slid = 0;
  for (int p = interface.point_begin; p < interface.point_end; ++p) {
    const geom::Vec3 gap = back * jump(model, state.displacement, p);
    const double normal = gap.dot(interface.normal);
    slid = std::max(slid, (gap - normal * interface.normal).norm());
    open = open && (gap - state.bond_offset[p]).dot(interface.normal) > parted * size &&
           traction(model, state, p).isZero(0);
  }
  if (open)
    return Fate::leaves;
  return slid > slid_too_far * size ? Fate::slides : slid > slid_enough * size ? Fate::slips : Fate::stays;
}

double stored_in(const Model& model, const State& state, const Interface& interface) {
  double energy = 0;
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    energy += spring_energy(model, state, p);
  return energy;
}

bool has_drained(const Model& model, const State& state, const Interface& interface) {
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    if (movement_past(model, state, p).norm() <= drained * model.frames[interface.frame].size)
      return false;
  return true;
}

bool any_water(const State& state, const Interface& interface) {
  return std::any_of(state.water_pressure.begin() + interface.point_begin,
                     state.water_pressure.begin() + interface.point_end, [](double p) { return p > 0; });
}

// Returns what the water had done, J.
double drain(const Model& model, State& state) {
  double work = 0;
  for (const Interface& interface : model.interfaces)
    if (released(state, interface) && any_water(state, interface) && has_drained(model, state, interface)) {
      work += water_work(model, state, interface);
      std::fill(state.water_pressure.begin() + interface.point_begin,
                state.water_pressure.begin() + interface.point_end, 0.0);
    }
  return work;
}

} // namespace

Released release_interfaces(const Model& model, State& state, int threads) {
  Released sum;
  if (model.frames.empty())
    return sum;
  const auto n = static_cast<std::int64_t>(model.interfaces.size());
  std::vector<Fate> fate(model.interfaces.size(), Fate::stays);
  for_chunks(n, threads, [&](std::int64_t i) {
    const Interface& interface = model.interfaces[i];
    if (interface.frame >= 0 && !released(state, interface) && !any_intact(state, interface))
      fate[i] = fate_of(model, state, interface);
  });
  geom::DisjointSets held(model.blocks.size());
  for (const Interface& interface : model.interfaces)
    if (interface.frame < 0 || !released(state, interface))
      held.unite(interface.block_a, interface.block_b);
  std::vector<char> slides(model.blocks.size(), 0),
      leaves = slides; // per block that stands for those held to it
  const auto held_by = [&](std::int64_t i) { return held.find(model.interfaces[i].block_a); };
  for (std::int64_t i = 0; i < n; ++i)
    if (fate[i] == Fate::slides)
      slides[held_by(i)] = 1;
  for (std::int64_t i = 0; i < n; ++i)
    if (fate[i] == Fate::slides || (fate[i] == Fate::slips && slides[held_by(i)] != 0)) {
      sum.slid.push_back(static_cast<int>(i));
    } else if (fate[i] == Fate::leaves) {
      const Interface& interface = model.interfaces[i];
      sum.stored += stored_in(model, state, interface);
      state.released[interface.frame] = 1;
      leaves[held_by(i)] = 1;
      ++sum.interfaces;
    }
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block)
    sum.blocks.push_back(leaves[held.find(block)]);
  if (!state.water_pressure.empty())
    sum.water = drain(model, state);
  return sum;
}

std::vector<std::pair<int, int>> held_pairs(const Model& model, const State& state) {
  std::vector<std::pair<int, int>> pairs;
  for (const Interface& interface : model.interfaces)
    if (interface.frame >= 0 && !released(state, interface))
      pairs.emplace_back(interface.block_a, interface.block_b);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<char> blocks_with_broken_bonds(const Model& model, const State& state) {
  std::vector<char> loose(model.blocks.size(), 0);
  for (const Interface& interface : model.interfaces)
    if (interface.frame >= 0 && told_of(state, interface.frame) != ToldOfBonds::whole)
      loose[interface.block_a] = loose[interface.block_b] = 1;
  return loose;
}

} // namespace cdem
