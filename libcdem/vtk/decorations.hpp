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
  double factor = 1;              // shown number = factor * SI value
  std::vector<std::int64_t> ids;  // one swatch each; empty: continuous
  std::vector<std::string> names; // of the ids 0, 1, ...; empty: the numbers stand beside the swatches
  std::string outliers;           // "all values: -3 to 340 MPa" where a few are far beyond the range
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
// Entries side by side, in as many rows as the width of the picture needs.
using LegendRows = std::vector<std::vector<LegendEntry>>;
LegendRows legend_rows(const Canvas&, const std::vector<LegendEntry>&, double picture_width, double pixel);
void draw_legend(Canvas&, const LegendRows&, const Layout&, double pixel);

// A length that is a round number of metres, some fifth of the body wide, over the lower right corner of the body.
void draw_scale_bar(Canvas&, const View&, const Layout&, double pixel);

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
// north: a direction that gets an arrow of its own, "N".
AxesContent axes_content(const View&, double pixel, const std::optional<geom::Vec3>& north = {});
void draw_axes(Canvas&, const AxesContent&, const Layout&, double pixel);

void draw_overlays(Canvas&, const std::vector<Marker>&, const std::vector<Polyline>&, const View&,
                   const Layout&, double pixel);

} // namespace cdem
