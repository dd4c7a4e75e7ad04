// Puts a picture together: what to colour, where the viewer stands, how the parts share the page, and draws
// it.
#include "libcdem/vtk/picture.hpp"

#include "libcdem/vtk/decorations.hpp"
#include "libcdem/vtk/save_drawing.hpp"
#include "libcdem/vtk/scene.hpp"
#include "libcdem/vtk/water_line.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

using Layers = std::vector<vtkRenderer*>;

void check_options(const PictureOptions& options) {
  if (!std::isfinite(options.deformation))
    throw geom::InputError("deformation", geom::text(options.deformation), "a finite number");
  if (!(options.opacity > 0 && options.opacity <= 1))
    throw geom::InputError("opacity", geom::text(options.opacity), "in (0, 1]");
  for (const Marker& marker : options.markers)
    geom::require_finite("markers.position", marker.position);
  if (options.north && !(options.north->norm() > 0 && options.north->allFinite()))
    throw geom::InputError("north", geom::place_text(*options.north), "a finite vector that is not zero");
  for (const Polyline& line : options.polylines)
    for (const geom::Vec3& x : line.points)
      geom::require_finite("polylines.points", x);
  if (!options.fit)
    return;
  geom::require_finite("fit.min", options.fit->min);
  geom::require_finite("fit.max", options.fit->max);
  if (options.camera)
    throw geom::InputError("fit: goes with view; a camera stands where it is told");
  if (!((options.fit->max - options.fit->min).minCoeff() >= 0 && options.fit->max != options.fit->min))
    throw geom::InputError("fit.max", geom::place_text(options.fit->max),
                           "at least fit.min in x, y and z, and not the same");
}

// Extent in view axes of the drawn bodies, or of the box to be shown if one is given.
geom::Box extent_of(const View& view, const PictureOptions& options, const std::vector<geom::Vec3>& points,
                    const BrokenInterfaces& broken, const std::vector<WaterSheet>& water) {
  if (options.fit)
    return view.extent(*options.fit);
  geom::Box extent = view.extent(points);
  for (const auto* part : {&broken.tension, &broken.shear})
    for (const geom::Triangle& t : part->triangles)
      for (const int v : t)
        extent.extend(view.in_view(broken.points[static_cast<std::size_t>(v)]));
  for (const Marker& marker : options.markers)
    extent.extend(view.in_view(marker.position));
  for (const Polyline& line : options.polylines)
    for (const geom::Vec3& x : line.points)
      extent.extend(view.in_view(x));
  for (const WaterSheet& sheet : water)
    for (const geom::Triangle& t : sheet.triangles)
      for (const int p : t)
        extent.extend(view.in_view(sheet.points[static_cast<std::size_t>(p)]));
  return extent;
}

// Over the extent of what is drawn, and no farther than the box that is to be shown.
std::vector<WaterSheet> shown_water(const Snapshot& snapshot, const std::vector<geom::Vec3>& points,
                                    const PictureOptions& options) {
  geom::Box box;
  for (const geom::Triangle& t : snapshot.surface)
    for (const int p : t)
      box.extend(points[static_cast<std::size_t>(p)]);
  if (options.fit) {
    box.min = box.min.cwiseMax(options.fit->min);
    box.max = box.max.cwiseMin(options.fit->max);
  }
  std::vector<WaterSheet> shown;
  for (const WaterSheet& sheet : snapshot.water)
    if (WaterSheet part = cropped(sheet, box); !part.triangles.empty())
      shown.push_back(std::move(part));
  return shown;
}

std::vector<LegendEntry> legend_entries(const PictureOptions& options, const BrokenInterfaces& broken,
                                        bool surface, bool line, const std::vector<Polyline>& arrows,
                                        double pixel) {
  std::vector<LegendEntry> entries;
  if (!broken.tension.triangles.empty())
    entries.push_back({"broken in tension", tension_colour, 7 * pixel});
  if (!broken.shear.triangles.empty())
    entries.push_back({"broken in shear", shear_colour, 7 * pixel});
  Colour over_white = water_colour;
  for (double& c : over_white)
    c = water_opacity * c + 1 - water_opacity;
  if (surface)
    entries.push_back({"water surface", over_white, 12 * pixel});
  if (line)
    entries.push_back({"water line", water_line_colour, 4 * pixel});
  if (!arrows.empty())
    entries.push_back({arrows.front().label, water_line_colour, 2.5 * pixel});
  for (const Polyline& drawn : options.polylines)
    if (!drawn.label.empty())
      entries.push_back({drawn.label, drawn.colour, drawn.width * pixel, drawn.dashed});
  if (options.deformation != 0 && options.deformation != 1)
    entries.push_back({"displacements \u00d7 " + geom::text(options.deformation)});
  return entries;
}

// The size to check: a picture as high as it needs is checked by its width.
std::array<int, 2> asked_size(const PictureOptions& options) {
  return {options.size[0], options.size[1] == 0 ? options.size[0] : options.size[1]};
}

// Puts the parts together and hands them to `finish`: size in pixels, the renderers of the model, what is drawn over them.
template <class Finish>
void draw(const Snapshot& snapshot, const PictureOptions& options, const Finish& finish) {
  const bool free_height = options.size[1] == 0;
  check_options(options);
  if (snapshot.surface.empty())
    throw geom::InputError("snapshot", "no faces", "a model with at least one block");

  const SnapshotField* displacement = displacement_of(snapshot.point_fields);
  if (options.deformation != 0 && !displacement)
    throw geom::InputError("deformation", geom::text(options.deformation),
                           "0: this result has no displacement");
  const std::vector<geom::Vec3> points = deformed(snapshot.points, displacement, options.deformation);
  BrokenInterfaces broken;
  if (options.broken_bonds)
    broken = broken_interfaces(snapshot.bonds, options.deformation);
  std::optional<FieldValues> field;
  ColourScale scale = colour_scale({}, false, options.colour_map, options.range);
  if (!options.field.empty()) {
    field = field_values(snapshot, options.field);
    leave_plain(snapshot, options.plain, *field);
    leave_inside(snapshot, *field);
    scale = colour_scale(field->values, field->id, options.colour_map, options.range);
  }

  View view = view_of(options, snapshot.points, snapshot.surface);
  const std::vector<WaterSheet> water = shown_water(snapshot, points, options);
  const std::vector<Segment> line = water_lines(water, points, snapshot.surface);
  const std::vector<Polyline> arrows = water_arrows(water);
  const geom::Box extent = extent_of(view, options, points, broken, water);

  const double pixel = std::min(options.size[0] / 1600., free_height ? 1e9 : options.size[1] / 1200.);
  Canvas canvas;
  std::optional<BarContent> bar;
  if (field && options.colour_bar)
    bar = bar_content(*field, scale);
  if (bar)
    bar->given_range = options.range.has_value();
  std::vector<LegendEntry> legend;
  if (options.legend)
    legend = legend_entries(
        options, broken,
        is_seen(water, points, options.opacity < 1 ? std::vector<geom::Triangle>() : snapshot.surface, view),
        !line.empty(), arrows, pixel);
  if (bar && !bar->outliers.empty())
    legend.push_back({bar->outliers});
  AxesContent axes;
  if (options.axes || options.north)
    axes = axes_content(view, pixel, options.north);
  // Beside the arrows, where these are under the body.
  const LegendRows rows = legend_rows(canvas, legend, options.size[0] - axes.size[0] - 50 * pixel, pixel);

  LayoutInput input;
  input.size = options.size;
  input.aspect = 0;
  if (!view.literal)
    input.aspect = std::clamp(extent.size().x() / std::max(extent.size().y(), 1e-300), 0.02, 50.);
  input.pixel = pixel;
  input.title = !options.title.empty();
  input.bar = bar.has_value();
  // Pictures from a camera of their own, or fitted to a box, are frames of a film: they keep the room of a legend that is
  // still empty, so that nothing moves when the first bond breaks, or the water comes.
  const bool may_break = options.broken_bonds && (snapshot.bonds.left_out || !snapshot.bonds.points.empty());
  const bool kept = (view.literal || options.fit) && options.legend && (may_break || !snapshot.water.empty());
  input.legend_rows = std::max(static_cast<int>(rows.size()), kept ? 1 : 0);
  // In perspective a length has no one size.
  input.scale_bar = options.scale_bar && !view.perspective;
  input.bar_column = bar ? bar_column_width(canvas, *bar, pixel) : 0;
  input.axes = axes.size;
  const Layout layout = arrange(input);

  if (view.literal)
    view.place(layout.body);
  else
    view.fit(extent, layout.body, 6 * pixel);

  if (input.title) {
    const double room = layout.size[0] - 40 * pixel,
                 wanted = canvas.text_width(options.title, title_font * pixel);
    const double font = title_font * pixel * std::min(1., room / wanted), half = 0.5 * std::min(wanted, room);
    const double x =
        std::clamp(layout.body.centre_x(), 20 * pixel + half, layout.size[0] - 20 * pixel - half);
    canvas.text(options.title, {x, layout.title_middle}, font, HorizontalAlign::centre,
                VerticalAlign::middle);
  }
  if (bar)
    draw_bar(canvas, *bar, layout, pixel);
  draw_legend(canvas, rows, layout, pixel);
  if (input.scale_bar)
    draw_scale_bar(canvas, view, layout, pixel);
  draw_axes(canvas, axes, layout, pixel);
  draw_overlays(canvas, options.markers, options.polylines, view, layout, pixel);

  const bool any_broken = !broken.tension.triangles.empty() || !broken.shear.triangles.empty();
  Scene scene({snapshot, points, field ? &*field : nullptr, scale, any_broken ? &broken : nullptr,
               options.edges, options.opacity, pixel, water, line, arrows},
              view, layout.size);
  finish(layout.size, scene.renderers(), canvas);
}

} // namespace

void render(const Snapshot& snapshot, const PictureOptions& options, const std::string& path) {
  check_drawing(asked_size(options), options.dpi, path);
  draw(snapshot, options, [&](const std::array<int, 2>& size, const Layers& model, Canvas& canvas) {
    save_drawing(size, options.dpi, model, canvas, path);
  });
}

std::string render_png(const Snapshot& snapshot, const PictureOptions& options) {
  check_drawing(asked_size(options), options.dpi);
  std::string bytes;
  draw(snapshot, options, [&](const std::array<int, 2>& size, const Layers& model, Canvas& canvas) {
    bytes = png_of_drawing(size, options.dpi, model, canvas);
  });
  return bytes;
}

} // namespace cdem
