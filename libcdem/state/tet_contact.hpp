// Two tetrahedra of one broken body that press on each other, or that were found in each other and carry nothing there
// (contact/pairs/tet_pressure.hpp).
#pragma once

#include "libgeom/core/types.hpp"

#include <cstdint>

namespace cdem {

struct TetContact {
  std::int32_t a = 0, b = 0;             // of the model, a < b
  double offset = 0;                     // m, depth up to which it carries nothing
  double normal = 0;                     // N; 0: it does not press
  double depth = 0, stored = 0;          // m, J: the largest phi and the energy of all, in the last step
  geom::Vec3 shear = geom::Vec3::Zero(); // N, on a
  double scale = 1; // of its stiffness: one that took over a force stores what the face did
  // J, of a face whose force (`shear` until then) it takes over when it is next computed; below 0: none.
  double taken_over = -1;
};

// They are sorted by it.
inline bool operator<(const TetContact& one, const TetContact& other) {
  return one.a < other.a || (one.a == other.a && one.b < other.b);
}

} // namespace cdem
