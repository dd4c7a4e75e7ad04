// Line charts on white: histories, convergence, comparison with reference points.
#pragma once

#include "libcdem/vtk/picture.hpp"

namespace cdem {

struct Series {
  std::string name;
  // Same length; pairs that are not finite, or not positive on a log axis, leave a gap.
  std::vector<double> x, y;
  bool right_axis = false;                     // y is read on the right
  std::string style = "line";                  // line, dashed, points, both
  std::optional<Colour> colour = std::nullopt; // else the next of the palette
};

// A thin upright line with its name: where something began.
struct ChartMark {
  double x = 0;
  std::string name;
};

struct ChartOptions {
  std::string title;
  // "_{...}" and "^{...}" set sub- and superscripts. A label that ends in an SI unit, "opening (m)", is that of values
  // in it; a linear axis then shows them with the prefix that suits, "opening (mm)".
  std::string x_label, y_label, right_label;
  bool log_x = false, log_y = false, log_right = false;
  std::array<int, 2> size = {1600, 1200}; // pixels
  double dpi = 300;                       // pixels in an inch of the printed chart
  std::string legend = "auto"; // auto: above the plot, where it covers no line; or top_left top_right
                               // bottom_left bottom_right (inside), none
  std::optional<std::array<double, 2>> x_range, y_range, right_range; // of the axes
  std::vector<ChartMark>
      marks; // by rising x; names of those that stand too near to be told apart share a line
};

// Writes a .png, .svg or .pdf. Throws geom::InputError for options or series that cannot be used, std::runtime_error when
// the machine offers no off-screen OpenGL.
void chart(const std::vector<Series>&, const ChartOptions&, const std::string& path);

} // namespace cdem
