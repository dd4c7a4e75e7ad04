// The fragments of blocks, as contact knows them: a contact belongs to the fragment on which it acts.
#pragma once

#include "libgeom/core/types.hpp"

#include <array>
#include <vector>

namespace cdem {

// Written by find_contact_fragments, when faces have broken.
struct ContactFragments {
  // Per node, and per triangle: what hangs together, by its smallest node. Over faces without a broken bond only, so that
  // the surface of what has broken is closed.
  std::vector<int> of_node, of_triangle;
  std::vector<char>
      active; // per triangle: 1 outside, or its face has a broken bond; 2 its face is left to contact; else 0
  // Per triangle, in the step in which fragments are told apart: its fragment is not the one it was, or another holds its face,
  // springs or contact. Its contacts may begin at any depth.
  std::vector<char> changed;
  std::vector<char> broken;            // per block: some of its faces have
  std::vector<int> number_of_triangle; // into the fragments of broken blocks; -1: of a block that is whole
  // Per fragment of a broken block: no bond holds its tets together, as in a fragment of a single tet.
  std::vector<char> one_piece;
  // Likewise: of a single tet its triangles, by number; of all others -1. A semi-spring outside one of their planes is outside the
  // tet, by as much at least: that is looked at before anything else.
  std::vector<std::array<int, 4>> triangles_of_tet;
};

} // namespace cdem
