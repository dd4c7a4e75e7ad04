// What stands around the body of a picture: colour bar, legend, axes; and what lies on it: markers, lines.
#pragma once

#include "libcdem/vtk/canvas.hpp"
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/layout.hpp"

namespace cdem {

// Labels of a colour bar, made before its place is known.
struct BarContent {
  std::string title; // "u_{x} (mm)"
  ColourScale scale;
  double factor = 1;                            // shown number = factor * SI value
  std::vector<std::int64_t> ids;                // one swatch each; empty: continuous
  bool beyond_low = false, beyond_high = false; // values outside the range: the bar ends in a point
  bool given_range = false; // pictures of a film have one: the title keeps clear of a point that may come
};

// Without content (no value, more ids than can be told apart): no bar.
std::optional<BarContent> bar_content(const FieldValues&, const ColourScale&);

double bar_column_width(const Canvas&, const BarContent&, double pixel);
void draw_bar(Canvas&, const BarContent&, const Layout&, double pixel);

struct LegendEntry {
  std::string text;
  Colour colour = {0, 0, 0};
  double width = 0; // of the sample line, pixels; 0: text alone
  bool dashed = false;
};
void draw_legend(Canvas&, const std::vector<LegendEntry>&, const Layout&, double pixel);

// The arrows of the model's x, y and z as the view shows them.
struct AxesContent {
  struct Arrow {
    std::string name;
    Canvas::Point tip; // from the common foot
  };
  std::vector<Arrow> arrows;
  Canvas::Point foot{0, 0}; // from the lower left of what is drawn
  std::array<double, 2> size{0, 0};
};
AxesContent axes_content(const View&, double pixel);
void draw_axes(Canvas&, const AxesContent&, const Layout&, double pixel);

void draw_overlays(Canvas&, const std::vector<Marker>&, const std::vector<Polyline>&, const View&,
                   const Layout&, double pixel);

} // namespace cdem
