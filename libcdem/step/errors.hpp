// How a solution ends early.
#pragma once

#include <stdexcept>
#include <string>

namespace cdem {

// NaN, an inverted element or a run-away displacement: names step, block and place. The Simulation holds the last
// good state when this is thrown.
class SolutionError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// The user asked to stop (Ctrl-C). The state is the one of the last whole step.
class Interrupted : public std::runtime_error {
public:
  Interrupted() : std::runtime_error("stopped by the user") {}
};

} // namespace cdem
