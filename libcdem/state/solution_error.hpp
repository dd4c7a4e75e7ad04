// A solution that cannot go on.
#pragma once

#include <stdexcept>

namespace cdem {

// NaN, an inverted element or a run-away displacement: names step, block and place. The Simulation holds the last
// good state when this is thrown.
class SolutionError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace cdem
