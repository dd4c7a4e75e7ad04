// Outlines of the letters of a text.
#pragma once

#include "libcdem/vtk/vector_page.hpp"

namespace cdem {

struct PathPiece {
  enum Kind { move, line, cubic } kind = move;
  std::array<std::array<double, 2>, 3> points{}; // one; of a cubic curve two controls and the end
};

std::vector<PathPiece>
glyph_path(const VectorText&); // in pixels of the drawing; closed pieces, filled by winding

} // namespace cdem
