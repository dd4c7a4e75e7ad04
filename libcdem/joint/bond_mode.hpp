// State of a bond.
#pragma once

#include <cstdint>

namespace cdem {

// Also the value of the bond field "mode".
enum class BondMode : int { intact = 0, broken_tension = 1, broken_shear = 2, contact = 3 };

inline bool is_intact(std::uint8_t mode) {
  return mode == static_cast<std::uint8_t>(BondMode::intact);
}

} // namespace cdem
