// A freed face of a cohesive body (bond/cohesive_faces.hpp). Vectors stand in the face's own axes, along its first edge,
// across, normal, but for the preload, which stands in space.
#pragma once

#include <array>

namespace cdem {

enum class FaceStage {
  holding,  // its sides hold together
  cracking, // a cohesive law acts on its working plane
  parted    // it carries nothing
};

struct CohesiveFace {
  using Vector = std::array<double, 3>;
  double stage = 0;               // FaceStage
  Vector plane{};                 // normal of the working plane, unit
  std::array<Vector, 3> offset{}; // m, per point: what the stretch of its law is more than its gap
  std::array<Vector, 3>
      rest{}; // Pa, per point: what the traction was beyond that of the plane, when it began
  std::array<double, 3> damage{};  // D, per point
  std::array<Vector, 3> slip{};    // m, per point, of the damaged part
  std::array<Vector, 3> preload{}; // N, per corner, on side a: dies away after a node has been freed

  FaceStage at() const { return static_cast<FaceStage>(static_cast<int>(stage)); }
};

} // namespace cdem
