// Faces between convex blocks that water reaches: where no bond holds them together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// What a flow meets of a block: some of its outer faces, or all of it, where the block, its body or everything was named.
enum class Met : char { nothing, places, whole };

// A face that lay on other blocks when the model was made. node_area: that part, less what bonds that hold still cover. A
// pressure always gets in, a stream where the faces have parted by more than a hundredth of the smaller block.
struct BaredFace {
  OuterFace face;
  bool parted = false;
};

// By block and face, ascending: of blocks that are met whole, and where those on both sides are met. So the pressures on the two
// sides of a closed joint cancel, and water in front of a wall pushes it. Springs that stand under water of their own
// (model:water) cover like bonds.
std::vector<BaredFace> opened_faces(const Model&, const State&, const std::vector<Met>&);

} // namespace cdem
