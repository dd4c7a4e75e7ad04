// Cut the blocks near failure along their failure plane into planes + 1 sub-blocks (Han 2010 section 3).
#pragma once

#include "libcdem/fracture/rebuild.hpp"

namespace cdem {

struct Refined {
  Rebuilt rebuilt;
  std::vector<BlockCut> cuts; // in the order of the blocks
};

// Throws geom::InputError when a value cannot be used or a body has no strength to judge by.
Refined refine(const Model&, const State&, const RefineOptions&);

} // namespace cdem
