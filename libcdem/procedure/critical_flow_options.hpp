// What the search for a critical flow takes and gives back; procedure/critical_flow.hpp says how it goes.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/results/fragment.hpp"
#include "libcdem/step/options.hpp"

#include <optional>
#include <vector>

namespace cdem {

struct CriticalFlowOptions {
  bool hold = true;
  Flow flow;                      // its velocity is the search's own
  std::optional<Selection> held;  // the side the solid is said to be held on: some node there must be
  double pressure_rate = 5e6;     // Pa/s, > 0
  double hold_periods = 3;        // of the first mode, > 0
  double fragment_fraction = 0.1; // of the volume, in (0, 1)
  double compliance_ratio = 10;   // > 1
  double max_velocity = 100;      // m/s: the search gives up
  double safety = 0.9;            // as in RunOptions
  MassScaling mass_scaling;       // as in RunOptions
  double local_damping = 0.1;     // as in RunOptions; above 0.2 it acts as added mass
};

struct CriticalFlowSample {
  double time = 0, pressure = 0, velocity = 0; // s since the start, Pa, m/s
  double displacement = 0;                     // m, mean under the flow's pattern
  std::int64_t broken = 0;                     // bonds since the start
};

struct CriticalFlowResult {
  enum class Reason { fragment, compliance, limit };
  Reason reason = Reason::limit;
  double pressure = 0, velocity = 0; // Pa, m/s, at the end
  double time = 0;                   // s, since the start
  double period = 0;                 // s, of the first mode
  double compliance = 0;             // m/Pa, unbroken and static
  std::vector<Fragment> fragments;   // largest first
  double broken_area = 0;            // m2
  geom::Vec3 place =
      geom::Vec3::Zero(); // m, centroid of the broken area, undeformed; zero when nothing broke
  // Values at the step in which the first bonds broke; zero if none did.
  double first_break_pressure = 0, first_break_velocity = 0; // Pa, m/s
  geom::Vec3 first_break_place = geom::Vec3::Zero();         // m, undeformed
  std::int64_t broken_tension = 0, broken_shear = 0;
  std::int64_t steps = 0;
  double time_step = 0;                  // s, at the end
  ScaledMasses scaled;                   // with mass_scaling
  std::vector<CriticalFlowSample> curve; // every 100 steps
};

} // namespace cdem
