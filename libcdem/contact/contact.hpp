// One contact that acts: a semi-spring pressed into a target face, or a semi-edge into a target edge, and what it
// remembers from step to step (Feng 2014 eqs 15-17).
#pragma once

#include "libgeom/core/types.hpp"

#include <algorithm>
#include <cstdint>

namespace cdem {

struct Contact {
  enum Kind : std::int32_t { spring, edge };
  std::int32_t kind = spring;
  std::int32_t source = 0; // 3 triangle + corner; of an edge where it starts on the first of its triangles
  // Of a spring's target, one contact for each: its block, or its fragment once it has broken. Of an edge its own second
  // triangle.
  std::int32_t piece = 0;
  std::int32_t target = 0;                // triangle; of an edge as source
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, out of the target
  geom::Vec3 shear = geom::Vec3::Zero();  // Fs, N, on the source
  double start = 0;                       // m, depth at which it carries nothing: it was found that deep
  double depth = 0;                       // m, below the target's surface

  double pressed() const { return std::max(0.0, depth - start); } // m
};

} // namespace cdem
