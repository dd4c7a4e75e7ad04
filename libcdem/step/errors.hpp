// How a solution ends early.
#pragma once

#include "libcdem/state/solution_error.hpp"

namespace cdem {

// The user asked to stop (Ctrl-C). The state is the one of the last whole step.
class Interrupted : public std::runtime_error {
public:
  Interrupted() : std::runtime_error("stopped by the user") {}
};

} // namespace cdem
