// A force that removed rock gave to a node, kept as a load after an excavation, and how it falls (load/excavation.hpp).
#pragma once

#include <cstdint>

namespace cdem {

struct ExcavationForce {
  std::int64_t node = 0;
  double x = 0, y = 0, z = 0;     // N, in full
  double before = 1, after = 0;   // 0 to 1: the share that acts until `begin`, and from `begin + duration` on
  double begin = 0, duration = 0; // s; it changes evenly in between

  double end() const { return begin + duration; }
  double share(double time) const {
    if (time >= end())
      return after;
    return time <= begin ? before : before + (after - before) * (time - begin) / duration;
  }
};

} // namespace cdem
