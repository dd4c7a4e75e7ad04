// Present contacts between bodies that move far: their positions, forces and bodies.
#pragma once

#include "libgeom/core/types.hpp"

#include <cstdint>
#include <vector>

namespace cdem {

struct Model;
struct State;

struct ContactPoint {
  geom::Vec3 place = geom::Vec3::Zero();           // m, now
  geom::Vec3 normal = geom::Vec3::Zero();          // N, on the source, out of the target
  geom::Vec3 shear = geom::Vec3::Zero();           // N, on the source
  double depth = 0;                                // m, of the overlap that carries
  std::int64_t source_block = 0, target_block = 0; // ids
  int source_body = 0, target_body = 0;            // from 0
  bool edge = false;                               // of two edges; else of a corner of a face in a face
};

std::vector<ContactPoint> contact_points(const Model&,
                                         const State&); // those that carry, in the order of the State

} // namespace cdem
