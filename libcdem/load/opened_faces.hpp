// Faces between convex blocks that water reaches: where no bond holds them together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// By block and face, ascending, as outer faces: node_area is the part that lay on other blocks when the model was made, less
// what bonds that hold still cover. A face that is left so is bare whatever lies on it now: what presses there takes the same
// pressure from the other side. Springs that stand under water of their own (model:water) cover too.
std::vector<OuterFace> opened_faces(const Model&, const State&);

} // namespace cdem
