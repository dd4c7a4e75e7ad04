// What settling takes and gives back.
#pragma once

#include "libcdem/step/timed_look.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cdem {

struct SettleOptions {
  double kinetic_energy_ratio =
      1e-6;                   // goal: kinetic energy over the largest there was in the stage, in (0, 1)
  bool rigid = true;          // free units fall as rigid bodies and deform when they rest
  double local_damping = 0.5; // of what touches, in [0, 1)
  std::optional<double> friction_angle; // rad, in [0, pi/2): contacts have no more of it in this stage
  double max_time = 60;                 // s of the model, over all phases
  double safety = 0.5;  // time step over the stable one, in (0, 1]: near 1 contacts that chatter gain energy
  double time_step = 0; // s, of the rigid phase; 0 = safety x stable
  std::int64_t callback_every = 0; // steps between calls of `callback`, in whole twenties; 0 never
  std::function<void()> callback;
  std::vector<TimedLook> looks;
};

struct SettlePhase {
  std::string name; // "rigid fall", "free fall", "deformable"
  std::int64_t steps = 0;
  double time = 0;          // s, it took of the model's
  double kinetic_ratio = 0; // at its end
  double residual = 0;      // out-of-balance force norm over applied force norm, at its end
};

struct SettleResult {
  bool converged = false;
  double kinetic_ratio = 0;
  double peak_kinetic = 0; // J
  std::int64_t steps = 0;
  double time = 0;             // s, it took of the model's
  std::int64_t made_rigid = 0; // units, for the first phase
  std::vector<SettlePhase> phases;
  std::string fastest;      // not converged: the name of the block that moves most; else empty
  double fastest_speed = 0; // m/s, sqrt(2 E / m) of its kinetic energy and mass
  double wall_time = 0;     // s
};

} // namespace cdem
