// Finds, in a block that has broken, the triangles of one fragment that the semi-springs of another may meet.
//
// Fragments fill space: where a body has just broken, some twenty of them meet at every node, and the boxes of their
// triangles all overlap there. Their tetrahedra do not. A semi-spring is further from a tetrahedron than it stands
// outside any of its four planes, which leaves few. They are found on a uniform grid of cells.
#pragma once

#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/broad_phase/renewed.hpp"

namespace cdem {

struct NearFragments {
  std::vector<std::vector<Near>> springs; // within the inner skins and the depth of contacts, in parts
  Pairs movers;                           // within the skins, of each pair the lower one first, sorted
};

// Only pairs in which at least one mover or the source is searched, for the tetrahedra of this rank's share. Adds to
// Renewed::sources what is near new surface.
NearFragments near_fragments(const Model&, const State&, const ContactWork&, const SearchMargin&,
                             const ActiveSurface&, int block, Renewed&, int threads);

} // namespace cdem
