// Gives interfaces whose faces have slid new springs. The faces are intersected in their present position and in the
// present plane of the interface. The new springs take over the state of the old ones (fracture/interface_memory.hpp).
// With X the undeformed positions of a spring on the sides a and b, its relative displacement is from now on
//
//   j = R^T (u_b - u_a + X_b - X_a),      o_n = preload and dilation,   o_s = j_s - elastic shear
//
// So the pressure follows from the position of the faces, the shear traction stays the same, and no rigid motion of the
// two blocks together strains the spring, for any slip. Where the faces do not overlap any more, the interface is left
// to contact.
#pragma once

#include "libcdem/fracture/interface_memory.hpp"

namespace cdem {

struct RenewedInterfaces {
  std::vector<int> old_point; // per spring, which it was before; -1: of an interface that was renewed
  std::int64_t left = 0;      // interfaces that are left to contact
  double lost = 0;            // J, that springs stored before and do not store now
  double water = 0;           // J, that water had done by opening what it presses on no more
};

// Interfaces that turn and hold no whole bond, ascending.
RenewedInterfaces renew_interfaces(Model&, State&, const std::vector<int>& interfaces, int threads);

// The same from what springs of another model remember; those that are left to contact already stay so. Its sums are 0.
struct InterfaceToRenew {
  int interface = 0;
  InterfaceMemory before;
};
RenewedInterfaces renew_interfaces(Model&, State&, const std::vector<InterfaceToRenew>&, int threads);

} // namespace cdem
