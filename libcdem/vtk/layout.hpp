// Where the parts of a picture go: title above the body, colour bar to its right or below it, legend and axes
// below or to the left, whatever lets the body be largest.
#pragma once

#include "libcdem/vtk/view.hpp"

namespace cdem {

struct LayoutInput {
  std::array<int, 2> size = {1600, 1200}; // height 0: chosen here
  double aspect = 1;                      // width over height of the body in the view; 0: take all the room
  double pixel = 1;                       // scale of fonts, lines and gaps; 1 for 1600 x 1200
  bool title = false, bar = false, scale_bar = false;
  int legend_rows = 0;
  double bar_column = 0;            // width of a vertical bar with its labels, pixels
  std::array<double, 2> axes{0, 0}; // size of the arrows with their letters, pixels; 0: none
};

struct Layout {
  std::array<int, 2> size; // of the picture
  Rect body;
  bool bar_vertical = true;
  Rect bar;                                   // the coloured strip alone
  double title_middle = 0, legend_middle = 0; // heights of the middle of the text; of the first row
  double legend_left = 0;                     // where the rows of the legend may begin
  std::array<double, 2> axes_corner{0, 0};    // lower left of the arrows
};

// Font sizes in pixels of a 1600 x 1200 picture.
inline constexpr double title_font = 42, label_font = 34;
inline constexpr double legend_row = 1.45 * label_font; // from one row of the legend to the next

Layout arrange(const LayoutInput&);

} // namespace cdem
