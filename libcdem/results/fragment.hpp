// A piece of a model that unbroken bonds hold together.
#pragma once

#include "libgeom/core/types.hpp"

namespace cdem {

struct Fragment {
  double volume = 0;                        // m3
  geom::Vec3 centroid = geom::Vec3::Zero(); // m, undeformed
  std::int64_t tets = 0;
  bool held = false; // a component of one of its nodes is held
};

} // namespace cdem
