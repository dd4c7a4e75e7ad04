// State of a bond.
#pragma once

namespace cdem {

// Also the value of the bond field "mode".
enum class BondMode : int { intact = 0, broken_tension = 1, broken_shear = 2, contact = 3 };

} // namespace cdem
