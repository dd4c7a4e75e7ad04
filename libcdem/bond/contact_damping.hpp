// The damping of springs that are contacts: broken or never bonded. A contact that opens or
// closes within a step dt gains or loses up to k (v dt)^2 / 8, and near the stable step vibrations grow on these errors.
// So a contact carries k beta times the rate of its stretch at least, with
//
//   beta = T / 4,   T the stable step without it
//
// whatever the step: a smaller `safety` changes no dashpot. A vibration of angular frequency w loses T w / 8 of critical
// damping: those of few steps die out, those of many steps feel nothing. The step has to be smaller for it,
//
//   dt^2 K / 4 + beta dt K / 2 <= M:   dt <= 0.78 T
#pragma once

#include <algorithm>
#include <cmath>

namespace cdem {

inline constexpr double contact_damping_part = 0.25; // beta over T

// s, the stable step with these dashpots. stable: without; infinite where nothing limits it.
inline double stable_step_of_dry_joints(double stable) {
  constexpr double c = contact_damping_part;
  return stable * (std::sqrt(1 + c * c) - c);
}

// s, beta. Less where the step is longer than the dashpots allow, as with masses that are scaled to a step.
inline double contact_damping(double step, double stable) {
  const double s = step / stable;
  return s < 1 && std::isfinite(stable) ? stable * std::min(contact_damping_part, 0.4 * (1 / s - s)) : 0;
}

} // namespace cdem
