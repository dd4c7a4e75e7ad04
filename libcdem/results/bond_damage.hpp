// How far a bond has gone: 0 whole .. 1 broken.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

inline bool has_broken(std::uint8_t mode) {
  return mode == static_cast<std::uint8_t>(BondMode::broken_tension) ||
         mode == static_cast<std::uint8_t>(BondMode::broken_shear);
}

// Of one spring of an interface. A contact that never was bonded has no damage.
inline double damage_of(const State& state, std::size_t p) {
  if (has_broken(state.bond_mode[p]))
    return 1;
  return state.bond_damage.empty() || state.bond_mode[p] == static_cast<std::uint8_t>(BondMode::contact)
             ? 0
             : state.bond_damage[p];
}

} // namespace cdem
