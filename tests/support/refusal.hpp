// What bad input is refused with.
#pragma once

#include "libgeom/core/error.hpp"

#include <string>

namespace testing {

// Message of the InputError that `act` throws; empty when it throws none.
template <class Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const geom::InputError& e) {
    return e.what();
  }
  return "";
}

} // namespace testing
