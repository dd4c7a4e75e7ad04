// Which triangles of two blocks, or of one with itself, are near each other: by their boxes, and by their planes, as a box
// says little of a large triangle that lies askew.
//
// Within the skins and the depth of contacts two triangles may meet. A source that may meet one of a block's triangles
// then needs to know of all those that may become the nearest to it: within two more skins of each block.
#pragma once

#include "libcdem/contact/taking_part.hpp"

namespace cdem {

using Pairs = std::vector<std::pair<int, int>>; // of triangles

struct NearTriangles {
  Pairs meeting;   // each once, the first block's first
  Pairs looked_at; // (source, target), both ways
};

NearTriangles near_triangles(const Model&, const State&, const ContactWork&, const Cover&, const TakingPart&,
                             int block_a, int block_b);

// Of one block: triangles of different pieces, and those of one that were far from each other at first.
NearTriangles near_triangles_within(const Model&, const State&, const ContactWork&, const Cover&,
                                    const TakingPart&, int block);

} // namespace cdem
