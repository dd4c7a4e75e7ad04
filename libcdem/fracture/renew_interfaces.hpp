// Interfaces whose faces have slid get new springs: the faces are intersected anew where they stand, in the plane that the
// interface has turned to, and the springs there go on from what the old ones remember (fracture/interface_memory.hpp).
// With X the undeformed places of a spring on the sides a and b, its jump from now on is
//
//   j = R^T (u_b - u_a + X_b - X_a),      o_n = preload and dilation,   o_s = j_s - elastic shear
//
// so that the pressure follows from where the faces stand, the shear traction goes on, and no rigid motion of the two
// blocks together strains the spring, however far one has slid past the other. Where the faces lie on each other no more,
// the interface is left to contact.
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
