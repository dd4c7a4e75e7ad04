// Which triangles of two blocks, or of one with itself, are near each other: by their boxes, and by their planes, since
// the box of a large oblique triangle is much larger than the triangle.
//
// Within the skins and the depth of contacts two triangles may meet. A source whose semi-springs may get into a block
// needs to know of all its triangles that may become the nearest to them: within two more skins of each block.
#pragma once

#include "libcdem/contact/broad_phase/active_surface.hpp"

namespace cdem {

using Pairs = std::vector<std::pair<int, int>>; // of triangles, by their places in ActiveSurface

// Triangles of two blocks that reach into the common part of their boxes, by their places in ActiveSurface, ascending.
struct SharedPart {
  int block_a = 0, block_b = 0;
  std::vector<int> of_a, of_b;
};
SharedPart shared_part(const ActiveSurface&, int block_a, int block_b, const Skins&);

// Those that meet, (of a, of b).
Pairs meeting(const SearchMargin&, const ActiveSurface&, const SharedPart&);

// (source, target), both ways.
Pairs looked_at(const Model&, const ContactWork&, const ActiveSurface&, const SharedPart&, const Skins&);

// Whether a semi-spring at x of another block may get into a block before the next search. One that stands outside the box
// around the block, or outside a plane of a pairwise one, stands outside the block, and nothing but a skin counts there.
bool may_get_into(const Model&, const ContactWork&, const ActiveSurface&, const geom::Vec3& x,
                  int source_block, int block, const Skins&);

// Near pairs within one block: triangles of different fragments, and triangles of one fragment that were apart in the
// undeformed body.
struct NearWithin {
  Pairs meeting;   // each once
  Pairs looked_at; // (source, target), both ways
};
NearWithin near_within(const Model&, const ContactWork&, const SearchMargin&, const ActiveSurface&,
                       int block);

} // namespace cdem
