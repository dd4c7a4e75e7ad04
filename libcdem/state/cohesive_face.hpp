// What a freed face of a cohesive body remembers beside its stage (state/face_state.hpp). Vectors stand in the face's own axes, along its first edge,
// across, normal, but for the preload, which stands in space.
#pragma once

#include <array>

namespace cdem {

struct CohesiveFace {
  using Vector = std::array<double, 3>;
  Vector plane{};                 // normal of the critical plane, unit
  std::array<Vector, 3> offset{}; // m, per point: w0, which the law adds to the relative displacement
  std::array<Vector, 3> start{};  // m, per point: the relative displacement with which a crack began
  std::array<double, 3>
      drawn{}; // a, per point: what is left of the part of w0 that is tension or cohesion, 1 .. 0
  std::array<Vector, 3>
      rest{}; // Pa, per point: what the traction was beyond that of the plane, when it began
  std::array<double, 3> damage{}; // D, per point
  std::array<Vector, 3> slip{}; // m, per point, of the damaged part; of a separated face also where it closes
  std::array<Vector, 3> preload{}; // N, per corner, on side a: dies away after a node has been freed
};

} // namespace cdem
