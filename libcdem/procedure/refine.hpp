// Cut the blocks near failure along their failure plane into planes + 1 sub-blocks (Han 2010 section 3).
#pragma once

#include "libcdem/fracture/rebuild.hpp"

namespace cdem {

struct Refined {
  Rebuilt rebuilt;
  std::vector<BlockCut> cuts; // in the order of the blocks
};

// Whether the block deforms, lies in the region, and has not been cut as often as it may be.
bool may_be_cut(const Model&, int block, const RefineOptions&);

// Throws geom::InputError when a value cannot be used or a body has no strength to judge by.
Refined refine(const Model&, const State&, const RefineOptions&);

} // namespace cdem
