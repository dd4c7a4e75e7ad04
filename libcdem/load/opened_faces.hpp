// Faces inside bodies that water reaches: between convex blocks where no bond holds them together, and in meshes where a crack has
// opened them. A pressure gets in at once, on both sides, so that in a closed joint or crack the two cancel. A stream gets in where
// the sides have parted by more than a hundredth of the block or unit, the cube root of its volume.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// What a flow meets of a block: some of its outer faces, or all of it, where the block, its body or everything was named.
enum class Met : char { nothing, places, whole };

// A face that lay on other blocks when the model was made. node_area: that part, less what bonds that hold still cover.
struct BaredFace {
  OuterFace face;
  bool parted = false; // from the smaller of two blocks
};

// One side of a crack in a mesh.
struct CrackSide {
  int block = 0;
  geom::Triangle nodes{}; // outward
  bool parted = false;    // or slid so far that the sides no longer lie on each other
};

// By block and face, ascending: of blocks that are met whole, and where those on both sides are met, so that water in front of a
// wall pushes it. Springs that stand under water of their own (model:water) cover like bonds.
std::vector<BaredFace> opened_faces(const Model&, const State&, const std::vector<Met>&);

// Both sides of each face without a bond, of meshes that are met.
std::vector<CrackSide> crack_sides(const Model&, const State&, const std::vector<Met>&);

} // namespace cdem
