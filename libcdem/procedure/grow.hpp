// A crack that grows in stages (Han 2010 section 4.2): balance without breaking, cut the blocks near the tip
// along their failure planes, balance, break only the worst faces, balance again until no face reaches its
// strength; that is one pass. Breaking every overloaded face at once would give a diffuse fan: the first one
// to go unloads its neighbours.
#pragma once

#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/procedure/grow_options.hpp"
#include "libcdem/step/observer.hpp"
#include "libcdem/step/options.hpp"

namespace cdem {

// What the driver works on; model and state stay at their place and change when a refined pair is adopted.
struct GrowContext {
  const Model& model;
  State& state;
  RunLog& log;
  Observer& observer;
  int stage = 0;
  std::function<RelaxResult(const RelaxOptions&, const std::string& kind)> relax;
  std::function<void(Rebuilt&&)> adopt;
};

// Throws geom::InputError when a value cannot be used or a joint softens; SolutionError and Interrupted as the relaxations do.
GrowResult grow(const GrowContext&, const GrowOptions&);

} // namespace cdem
