// The damping of springs that are contacts: broken or never bonded, between blocks that move far. A contact that opens or
// closes within a step dt gains or loses up to k (v dt)^2 / 8, and near the stable step vibrations grow on these errors.
// So a contact carries k beta times the rate of its stretch at least, with
//
//   beta = c dt,   c = min(0.5, 0.4 (1 / s^2 - 1)),   s = dt over the stable step
//
// A vibration of angular frequency w loses c w dt / 2 of critical damping: those of few steps die out, those of many
// steps feel nothing. The step stays stable, since dt^2 K / 4 + beta dt K / 2 = (s^2 + 2 c s^2) M <= (0.8 + 0.2 s^2) M.
#pragma once

#include <algorithm>

namespace cdem {

// s; step, stable: s, stable infinite where nothing limits it.
inline double contact_damping(double step, double stable) {
  const double s = step / stable;
  return s < 1 ? step * std::min(0.5, 0.4 * (1 / (s * s) - 1)) : 0;
}

} // namespace cdem
