// A mover is a body that moves by itself: a block, or a fragment of a block with broken faces.
#pragma once

#include "libgeom/core/types.hpp"

#include <array>
#include <vector>

namespace cdem {

// What is not as it was when fragments were told apart before, of a triangle: each holds what stands before it.
enum class Change : char {
  none,
  fragment, // or who holds its face: springs or contact
  surface   // it was not active
};

// What movers there are. Those of blocks come first and have the numbers of their blocks. Written by find_fragments, when
// faces have broken.
struct Movers {
  // Per node, and per triangle: what hangs together, by its smallest node. Over faces without a broken bond only, so that
  // the surface of what has broken is closed.
  std::vector<int> fragment_of_node, fragment_of_triangle;
  std::vector<char>
      active; // per triangle: 1 outside, or its face has a broken bond; 2 its face is left to contact; else 0
  // Per triangle, where fragments were told apart for this look: its contacts may begin at any depth.
  std::vector<Change> changed;
  std::vector<char> broken; // per block: some of its faces have
  std::vector<int>
      of_triangle; // of each triangle that takes part: its block, or its fragment where faces have broken
  std::vector<int> block;    // per mover
  std::vector<int> fragment; // per mover, its smallest node; -1: a block
  std::vector<int> node_begin,
      nodes; // per fragment, from the first after the blocks on: the nodes of its triangles
  // Per mover, for fragments: no bond holds its tets together, as in a fragment of a single tet.
  std::vector<char> one_piece;
  // Per mover, of fragments that are a single tet: its triangles, by number; of all others -1. A semi-spring outside one of
  // their planes is outside the tet, by as much at least: that is looked at before anything else.
  std::vector<std::array<int, 4>> triangles_of_tet;

  int count() const { return static_cast<int>(block.size()); }
};

// How the movers have moved since they were searched.
struct MoverMotion {
  std::vector<double> skin; // m, per mover: how far it may go before the next search; written by choose_skins
  std::vector<double> travelled;         // m, per mover, at most, since the search
  std::vector<double> last_displacement; // m, per mover, at most, in the last step
  double last_step = 0;                  // s, the last one in which anything moved
  // For fragments, per mover, since their last search: mean displacement of their nodes, and largest deviation of a
  // node from it, m. Measured from the positions at that search (n_nodes).
  std::vector<geom::Vec3> drift;
  std::vector<double> swing;
  std::vector<geom::Vec3> at_search; // m
};

} // namespace cdem
