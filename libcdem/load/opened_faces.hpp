// Faces between convex blocks that water reaches: where no bond holds them together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// How much of a block a flow meets.
enum class Met : char {
  nothing,
  places,
  whole
}; // places: some of its outer faces; whole: it, its body or everything was named

// A face that lay on other blocks when the model was made. node_area: that part, less what bonds that hold still cover.
struct BaredFace {
  OuterFace face;
  bool parted =
      false; // by more than a hundredth of the smaller block: a stream gets in; a pressure always does
};

// By block and face, ascending: of blocks that are met whole, and where those on both sides are met. So the pressures on the two
// sides of a closed joint cancel, and water in front of a wall pushes it. Springs that stand under water of their own
// (model:water) cover like bonds.
std::vector<BaredFace> opened_faces(const Model&, const State&, const std::vector<Met>&);

} // namespace cdem
