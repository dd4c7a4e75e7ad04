// Supports and loads as the user states them. They refer to places, not to nodes, so they survive cutting.
#pragma once

#include "libcdem/model/selection.hpp"

#include <array>
#include <optional>

namespace cdem {

// Factor over time (s; pseudo-time in a relaxation, where it is evaluated once at the start); empty means 1.
using Amplitude = std::function<double(double time)>;

struct Fix {
  Selection on;
  std::array<bool, 3> axes{true, true, true};
  bool release = false; // sets the components free instead; later ones win over earlier ones
  // m, total value; a relaxation moves there in its first steps and holds it
  std::optional<geom::Vec3> displacement;
  std::optional<geom::Vec3> velocity; // m/s, in real-time stepping; zero when not given
};

struct Traction {
  Selection on;
  geom::Vec3 stress = geom::Vec3::Zero(); // Pa, force over undeformed area, not following the surface
  Amplitude amplitude;
};

struct PointForce {
  Selection on;                          // nodes; shared in proportion to the volume around each
  geom::Vec3 force = geom::Vec3::Zero(); // N, total
  Amplitude amplitude;
};

struct Gravity {
  geom::Vec3 acceleration = geom::Vec3::Zero(); // m/s2
  double water_density = 0;                     // kg/m3; takes from the weight, never from the inertia
  Amplitude amplitude;
};

struct Conditions {
  std::vector<Fix> fixes;
  std::vector<Traction> tractions;
  std::vector<PointForce> forces;
  std::optional<Gravity> gravity;
};

} // namespace cdem
