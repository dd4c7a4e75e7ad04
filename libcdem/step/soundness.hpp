// Faults that end a stage: each throws a SolutionError that names stage, step, block and place.
#pragma once

#include "libcdem/step/escape.hpp"
#include "libcdem/step/workspace.hpp"

#include <string>

namespace cdem {

struct StageStep {
  int stage = 0; // from 1
  const std::string& kind;
  std::int64_t step = 0; // within the stage
};

// Every number is one, no node has gone further than run_away (m), no element is inside out.
void require_sound(const Model&, const State&, double run_away, const StageStep&);

// True if neither require_sound nor require_neighbours finds a fault in this rank's share of a State that several ranks
// advance.
bool share_is_sound(const Model&, const State&, const Workspace&, double run_away);

// Throws SolutionError where a block of small strain has left a neighbour by more than the size of their face.
void require_neighbours(const Model&, const State&, const StageStep&);

// What left the model did not gain its speed from an instability: the energy balance is open by less than 10 %.
void require_kept_energy(const Model&, const State&, const Escape&, const StageStep&);

// One line for the user.
std::string in_words(const Escape&, const State&, const StageStep&);

// The sides of broken faces are where their own springs can stand for the contact of the pieces.
void require_followed(const Model&, const Workspace&, const StageStep&);

// Ends the run for a contact that is too deep to be valid.
[[noreturn]] void refuse_depth(const Model&, const State&, int source_triangle, int target_triangle,
                               const StageStep&);

} // namespace cdem
