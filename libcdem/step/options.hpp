// What the solving calls take and give back.
#pragma once

#include "libcdem/step/timed_look.hpp"
#include "libgeom/core/types.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace cdem {

struct Progress;

// What every stage gives back.
struct StageResult {
  std::int64_t steps = 0;
  double residual = 0;             // out-of-balance force norm over applied force norm, at the end
  std::int64_t broken_tension = 0; // in this stage
  std::int64_t broken_shear = 0;
  double wall_time = 0; // s
};

// Dynamic relaxation to static balance (Han 2010 eq 12) with fictitious masses and adaptive damping.
struct RelaxOptions {
  double residual = 1e-6;          // goal: out-of-balance force norm over applied force norm, in (0, 1)
  bool breaking = true;            // bonds may break
  std::int64_t max_steps = 500000; // gives up with converged = false, > 0
  bool stop_on_failure = false;    // ends where the model is failing (procedure/stability.hpp)
  std::string note;                // what the progress shows of it, "F = 1.25"
  std::int64_t callback_every = 0; // steps between calls of `callback`; 0 never
  std::function<void()> callback;
  std::vector<TimedLook> looks;
  std::int64_t history_every = 0; // steps between samples of the history from now on; 0: as before
};

enum class Verdict : std::uint8_t { stable, failing, undecided };
const char* name(Verdict); // "stable", ...

struct RelaxResult : StageResult {
  bool converged = false;
  // stable: converged. failing: runs away (procedure/stability.hpp). undecided: max_steps came before either.
  Verdict verdict = Verdict::undecided;
  // Largest displacement between the last two looks, 200 steps apart: m, its block (an id) and where (undeformed, m).
  double moving = 0;
  std::int64_t moving_block = 0;
  geom::Vec3 moving_place = geom::Vec3::Zero();
  std::int64_t broken_while_drawn = 0; // bonds, as supports were drawn along (procedure/support_way.hpp)
  double way_done = 1;                 // part of the way of moved supports
};

// Masses raised where the time step demands it (integrate/mass_scaling.hpp): at most one of the two is given.
struct MassScaling {
  double step = 0;   // s, the time step
  double factor = 0; // over `safety` times the stable step of the true masses, >= 1

  bool on() const { return step > 0 || factor > 0; }
};

// What it came to.
struct ScaledMasses {
  double added_share = 0;   // mass added, over that of all that deforms, at the end
  std::string body;         // the one with the largest share of its own mass added; empty: none
  double body_share = 0;    // that share
  double kinetic_share = 0; // kinetic over elastic and spring energy, mean over the stage
};

// Explicit stepping with the real masses.
struct RunOptions {
  double duration = 0; // s; 0 when `steps` is given
  std::int64_t steps = 0;
  double safety = 0.9;  // time step over the stable one, in (0, 1]; of rigid bodies that touch 0.5 at most
  double time_step = 0; // s; 0 = safety x stable; refused above the stable one, half of it for rigid bodies
  MassScaling mass_scaling;
  bool breaking = true;
  bool follows_fragments =
      true; // ends with a SolutionError where broken faces no longer stand for the pieces' contact
  bool holds_what_left = false; // a piece that has left the model is held at once (step/escape.hpp)
  // Cundall's: force against the motion, as a fraction of the out-of-balance force, [0, 1)
  double local_damping = 0;
  bool damp_flight = true; // of rigid bodies that touch nothing too
  // Tangent: contacts with more friction have no more than this.
  double most_friction = std::numeric_limits<double>::infinity();
  // Every pair that is near is looked at in every step, after a search of everything: what is skipped otherwise must not
  // change a bit. For tests.
  bool looks_at_all_contacts = false;
  std::int64_t callback_every = 0;
  std::function<void()> callback;
  std::vector<TimedLook> looks;
  std::int64_t history_every = 0;         // as of a relaxation
  std::function<void(Progress&)> details; // adds to what the progress line shows
  std::function<bool()> stop;             // asked every callback_every (default 100) steps
  // Where the out-of-balance force over the applied force is above this, `stop` is asked in vain.
  double stop_residual = std::numeric_limits<double>::infinity();
};

struct RunResult : StageResult {
  double time = 0;      // s, model time reached
  double time_step = 0; // s
  ScaledMasses scaled;  // with mass_scaling
};

} // namespace cdem
