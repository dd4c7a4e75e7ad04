// What a Simulation is made of; only simulation*.cpp see it.
#pragma once

#include "libcdem/simulated_model.hpp"
#include "libcdem/simulation.hpp"
#include "libcdem/simulation_warnings.hpp"
#include "libcdem/stage_sequence.hpp"
#include "libgeom/core/error.hpp"

namespace cdem {

struct Simulation::Impl : SimulatedModel {
  Warnings warnings{*this};
  StageSequence stages{*this, warnings};
  std::size_t watches = 0; // made by the script so far
};

} // namespace cdem
