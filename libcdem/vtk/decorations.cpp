#include "libcdem/vtk/decorations.hpp"

#include "libcdem/vtk/labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace cdem {
namespace {

constexpr std::size_t most_swatches = 12;
constexpr double tick_length = 10, label_gap = 10, line_width = 2;

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", std::abs(value));
  return (value < 0 ? "\u2212" : "") + std::string(text);
}

std::vector<std::string> bar_labels(const BarContent& bar, const std::vector<double>& ticks) {
  if (bar.ids.empty())
    return tick_labels(ticks);
  std::vector<std::string> labels;
  for (const std::int64_t id : bar.ids)
    if (id >= 0 && static_cast<std::size_t>(id) < bar.names.size())
      labels.push_back(bar.names[static_cast<std::size_t>(id)]);
    else
      labels.push_back((id < 0 ? "\u2212" : "") + std::to_string(std::abs(id)));
  return labels;
}

// Shown numbers of the ticks; for swatches the middles of 0 .. n.
std::vector<double> bar_ticks(const BarContent& bar, int count) {
  if (bar.ids.empty())
    return round_ticks(bar.factor * bar.scale.low, bar.factor * bar.scale.high, count);
  std::vector<double> ticks;
  for (std::size_t i = 0; i < bar.ids.size(); ++i)
    ticks.push_back(static_cast<double>(i) + 0.5);
  return ticks;
}

} // namespace

std::optional<BarContent> bar_content(const FieldValues& field, const ColourScale& scale) {
  BarContent bar;
  bar.scale = scale;
  std::set<std::int64_t> ids;
  if (field.integer) {
    for (const double value : field.values)
      if (!std::isnan(value) && ids.size() <= most_swatches) // plain bodies have none
        ids.insert(std::llround(value));
    if (ids.size() <= most_swatches)
      bar.ids.assign(ids.begin(), ids.end());
  }
  if (field.values.empty() || (scale.map == "categorical" && bar.ids.empty()))
    return std::nullopt;
  const DisplayUnit unit = bar.ids.empty()
                               ? display_unit(field.unit, std::max(std::abs(scale.low), std::abs(scale.high)))
                               : DisplayUnit{};
  bar.factor = unit.factor;
  bar.names = field.names;
  if (scale.all && bar.ids.empty())
    bar.outliers = "all values: " + short_text(unit.factor * (*scale.all)[0]) + " to " +
                   short_text(unit.factor * (*scale.all)[1]) + (unit.text.empty() ? "" : " " + unit.text);
  bar.title = field.symbol + (unit.text.empty() ? "" : " (" + unit.text + ")");
  const double slack = 1e-6 * (scale.high - scale.low);
  for (const double value : field.values) {
    bar.beyond_low = bar.beyond_low || value < scale.low - slack;
    bar.beyond_high = bar.beyond_high || value > scale.high + slack;
  }
  return bar;
}

double bar_column_width(const Canvas& canvas, const BarContent& bar, double pixel) {
  const double font = label_font * pixel;
  const double labels = canvas.widest(bar_labels(bar, bar_ticks(bar, 8)), font);
  const double strip = (44 + 36) * pixel;
  return std::max(strip + (tick_length + label_gap) * pixel + labels,
                  44 * pixel + canvas.text_width(bar.title, font));
}

void draw_bar(Canvas& canvas, const BarContent& bar, const Layout& layout, double pixel) {
  Rect r = layout.bar;
  const bool vertical = layout.bar_vertical;
  if (!bar.ids.empty()) { // a few ids need no long bar
    const double label = vertical ? 0 : canvas.widest(bar_labels(bar, bar_ticks(bar, 0)), label_font * pixel);
    const double enough =
        std::max(90 * pixel, label + label_font * pixel) * static_cast<double>(bar.ids.size());
    const double spare = std::max(0., (vertical ? r.height : r.width) - enough);
    if (vertical)
      r = {r.left, r.bottom + spare, r.width, r.height - spare};
    else
      r = {r.left + spare / 2, r.bottom, r.width - spare, r.height};
  }
  const double font = label_font * pixel, length = vertical ? r.height : r.width;
  const double start = vertical ? r.bottom : r.left, across = vertical ? r.width : r.height;
  const auto piece = [&](double from, double to, const Colour& colour) { // along the bar, 0 .. 1
    canvas.rectangle(vertical ? Rect{r.left, start + from * length, across, (to - from) * length}
                              : Rect{start + from * length, r.bottom, (to - from) * length, across},
                     colour);
  };
  const bool swatches = !bar.ids.empty();
  const int n = swatches ? static_cast<int>(bar.ids.size()) : 256;
  for (int i = 0; i < n; ++i) {
    const double value = swatches ? static_cast<double>(bar.ids[static_cast<std::size_t>(i)])
                                  : bar.scale.low + (bar.scale.high - bar.scale.low) * (i + 0.5) / n;
    // A hair of overlap, so that no white line shows between two pieces.
    piece(double(i) / n, std::min(1., (i + 1 + (swatches ? 0 : 0.5)) / n), bar.scale(value));
  }
  canvas.frame(r, line_width * pixel, black);
  const auto point = [&](bool high) { // a triangle at the end: there are values beyond it
    const double base = start + (high ? length : 0), tip = base + (high ? 1 : -1) * 0.7 * across;
    const double side = vertical ? r.left : r.bottom;
    const auto corner = [&](double along, double over) {
      return vertical ? Canvas::Point{over, along} : Canvas::Point{along, over};
    };
    const std::vector<Canvas::Point> corners = {corner(base, side), corner(base, side + across),
                                                corner(tip, side + across / 2)};
    canvas.polygon(corners, bar.scale(high ? bar.scale.high : bar.scale.low));
    for (std::size_t c = 0; c < 3; ++c)
      canvas.line(corners[c], corners[(c + 1) % 3], line_width * pixel, black);
  };
  if (bar.beyond_low)
    point(false);
  if (bar.beyond_high)
    point(true);

  // As many ticks as their labels leave room for.
  const double label_room =
      vertical ? 2.4 * font : 1.3 * canvas.widest(bar_labels(bar, bar_ticks(bar, 6)), font) + font;
  const std::vector<double> ticks = bar_ticks(bar, std::clamp(static_cast<int>(length / label_room), 2, 8));
  const std::vector<std::string> labels = bar_labels(bar, ticks);
  const double low = swatches ? 0 : bar.factor * bar.scale.low;
  const double high = swatches ? n : bar.factor * bar.scale.high;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double at = start + length * (ticks[i] - low) / (high - low);
    if (vertical) {
      canvas.line({r.right(), at}, {r.right() + tick_length * pixel, at}, line_width * pixel, black);
      canvas.text(labels[i], {r.right() + (tick_length + label_gap) * pixel, at}, font, HorizontalAlign::left,
                  VerticalAlign::middle);
    } else {
      canvas.line({at, r.bottom}, {at, r.bottom - tick_length * pixel}, line_width * pixel, black);
      canvas.text(labels[i], {at, r.bottom - (tick_length + label_gap) * pixel}, font,
                  HorizontalAlign::centre, VerticalAlign::top);
    }
  }
  const double above =
      r.top() + (vertical && (bar.beyond_high || bar.given_range) ? 0.7 * across : 0) + 0.8 * font;
  canvas.text(bar.title, {vertical ? r.left : r.centre_x(), above}, font,
              vertical ? HorizontalAlign::left : HorizontalAlign::centre, VerticalAlign::baseline);
}

namespace {

constexpr double legend_sample = 60, legend_gap = 14, legend_between = 56, legend_margin = 32;

double legend_width(const Canvas& canvas, const LegendEntry& entry, double pixel, double font) {
  return (entry.width > 0 ? (legend_sample + legend_gap) * pixel : 0) + canvas.text_width(entry.text, font);
}

double legend_width(const Canvas& canvas, const std::vector<LegendEntry>& row, double pixel, double font) {
  double width = -legend_between * pixel;
  for (const LegendEntry& entry : row)
    width += legend_width(canvas, entry, pixel, font) + legend_between * pixel;
  return width;
}

// The words of a text in lines that are no wider than the room, as far as words allow it.
std::vector<std::string> wrapped(const Canvas& canvas, const std::string& text, double font, double room) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    if (lines.empty() || canvas.text_width(lines.back() + " " + word, font) > room)
      lines.push_back(word);
    else
      lines.back() += " " + word;
    from = end + 1;
  }
  return lines;
}

} // namespace

LegendRows legend_rows(const Canvas& canvas, const std::vector<LegendEntry>& entries, double picture_width,
                       double pixel) {
  const double font = label_font * pixel, room = picture_width - 2 * legend_margin * pixel;
  LegendRows rows;
  for (const LegendEntry& entry : entries) {
    if (!rows.empty()) {
      rows.back().push_back(entry);
      if (legend_width(canvas, rows.back(), pixel, font) <= room)
        continue;
      rows.back().pop_back();
    }
    const double sample = entry.width > 0 ? (legend_sample + legend_gap) * pixel : 0;
    bool first = true;
    for (const std::string& line : wrapped(canvas, entry.text, font, room - sample)) {
      rows.push_back({entry});
      rows.back().back().text = line;
      if (!first)
        rows.back().back().width = 0;
      first = false;
    }
  }
  return rows;
}

void draw_legend(Canvas& canvas, const LegendRows& rows, const Layout& layout, double pixel) {
  const double edge = legend_margin * pixel, left = layout.legend_left, room = layout.size[0] - edge - left;
  double middle = layout.legend_middle;
  for (const std::vector<LegendEntry>& row : rows) {
    double font = label_font * pixel, total = legend_width(canvas, row, pixel, font);
    if (total > room) { // a word that is wider than the picture
      font *= room / total;
      total = legend_width(canvas, row, pixel, font);
    }
    double x =
        std::clamp(layout.body.centre_x() - total / 2, left, std::max(left, layout.size[0] - edge - total));
    for (const LegendEntry& entry : row) {
      double at = x;
      if (entry.width > 0) {
        canvas.polyline({{at, middle}, {at + legend_sample * pixel, middle}}, entry.width, entry.colour,
                        entry.dashed);
        at += (legend_sample + legend_gap) * pixel;
      }
      canvas.text(entry.text, {at, middle}, font, HorizontalAlign::left, VerticalAlign::middle);
      x += legend_width(canvas, entry, pixel, font) + legend_between * pixel;
    }
    middle -= legend_row * pixel;
  }
}

void draw_scale_bar(Canvas& canvas, const View& view, const Layout& layout, double pixel) {
  const double wanted = 0.2 * layout.body.width * view.metres_per_pixel;
  const double decade = std::pow(10., std::floor(std::log10(wanted)));
  const double length = decade * (wanted >= 5 * decade ? 5 : wanted >= 2 * decade ? 2 : 1);
  const DisplayUnit unit = display_unit("m", length);
  const std::string text = short_text(unit.factor * length) + " " + unit.text;
  const double width = length / view.metres_per_pixel, font = label_font * pixel, end = 8 * pixel;
  const double right = layout.body.right(), y = layout.body.bottom - 0.5 * font;
  for (const double x : {right - width, right})
    canvas.line({x, y - end}, {x, y + end}, 3 * pixel, black);
  canvas.line({right - width, y}, {right, y}, 3 * pixel, black);
  canvas.text(text, {right - width / 2, y - 1.5 * end}, font, HorizontalAlign::centre, VerticalAlign::top);
}

namespace {

// Over the size of the font: how far beyond the tip of its arrow the middle of a name stands.
double letter_reach(const std::string& name) {
  return std::max(0.6, 0.4 * static_cast<double>(name.size()));
}

} // namespace

AxesContent axes_content(const View& view, double pixel, const std::optional<geom::Vec3>& north) {
  AxesContent axes;
  const double length = 84 * pixel, font = 0.9 * label_font * pixel;
  std::vector<std::pair<std::string, geom::Vec3>> directions;
  directions.reserve(4);
  for (int i = 0; i < 3; ++i)
    directions.emplace_back(std::string(1, "xyz"[i]), geom::Vec3::Unit(i));
  if (north) {
    const geom::Vec3 to = north->normalized();
    const auto same = std::find_if(directions.begin(), directions.end(),
                                   [&](const auto& d) { return d.second.dot(to) > 0.999; });
    if (same != directions.end())
      same->first += "=N";
    else
      directions.emplace_back("N", to);
  }
  Canvas::Point low{0, 0}, high{0, 0};
  for (const auto& [name, direction] : directions) {
    const double along = view.right.dot(direction), upward = view.up.dot(direction);
    if (std::hypot(along, upward) < 0.15) // points at the viewer or away
      continue;
    axes.arrows.push_back({name, {length * along, length * upward}});
    // The letter stands beyond the tip and needs room all round.
    const double reach = 1 + letter_reach(name) * font / length / std::hypot(along, upward);
    const Canvas::Point letter = {length * along * reach, length * upward * reach};
    const double half[2] = {std::max(0.5, 0.3 * static_cast<double>(name.size())) * font, 0.5 * font};
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], letter[k] - half[k]);
      high[k] = std::max(high[k], letter[k] + half[k]);
    }
  }
  axes.foot = {-low[0], -low[1]};
  axes.size = {high[0] - low[0], high[1] - low[1]};
  return axes;
}

void draw_axes(Canvas& canvas, const AxesContent& axes, const Layout& layout, double pixel) {
  const Canvas::Point foot = {layout.axes_corner[0] + axes.foot[0], layout.axes_corner[1] + axes.foot[1]};
  const double font = 0.9 * label_font * pixel;
  for (const AxesContent::Arrow& arrow : axes.arrows) {
    canvas.arrow(foot, {foot[0] + arrow.tip[0], foot[1] + arrow.tip[1]}, 3.5 * pixel, black);
    const double reach = 1 + letter_reach(arrow.name) * font / std::hypot(arrow.tip[0], arrow.tip[1]);
    // Small letters: their middle lies at half the x-height, below that of a digit.
    canvas.text(arrow.name, {foot[0] + reach * arrow.tip[0], foot[1] + reach * arrow.tip[1] + 0.09 * font},
                font, HorizontalAlign::centre, VerticalAlign::middle);
  }
}

namespace {

// The pieces of a line that lie in the rectangle (Liang and Barsky 1984).
std::vector<std::vector<Canvas::Point>> clipped(const std::vector<Canvas::Point>& line, const Rect& r) {
  const Canvas::Point low{r.left, r.bottom}, high{r.right(), r.top()};
  std::vector<std::vector<Canvas::Point>> pieces;
  bool goes_on = false;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Canvas::Point &a = line[i - 1], d{line[i][0] - a[0], line[i][1] - a[1]};
    double from = 0, to = 1;
    for (std::size_t k = 0; k < 2; ++k) {
      const double one = (low[k] - a[k]) / d[k], other = (high[k] - a[k]) / d[k];
      if (d[k] != 0) {
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
      } else if (a[k] < low[k] || a[k] > high[k]) {
        to = -1;
      }
    }
    if (from < to) {
      const auto at = [&](double t) { return Canvas::Point{a[0] + t * d[0], a[1] + t * d[1]}; };
      if (!goes_on || from > 0)
        pieces.push_back({at(from)});
      pieces.back().push_back(at(to));
    }
    goes_on = from < to && to == 1;
  }
  return pieces;
}

} // namespace

void draw_overlays(Canvas& canvas, const std::vector<Marker>& markers, const std::vector<Polyline>& polylines,
                   const View& view, const Layout& layout, double pixel) {
  constexpr Colour white = {1, 1, 1};
  for (const Polyline& line : polylines) {
    std::vector<Canvas::Point> points;
    for (const geom::Vec3& x : line.points)
      if (view.in_front(x))
        points.push_back(view.pixel(x));
    for (const auto& piece : clipped(points, layout.body)) {
      if (!line.dashed) // the gaps of a dashed line show what lies below
        canvas.polyline(piece, (line.width + 3) * pixel, white);
      canvas.polyline(piece, line.width * pixel, line.colour, line.dashed);
    }
  }
  const double font = label_font * pixel;
  for (const Marker& marker : markers) {
    if (!view.in_front(marker.position))
      continue;
    const Canvas::Point at = view.pixel(marker.position);
    const Rect& r = layout.body;
    if (at[0] < r.left || at[0] > r.right() || at[1] < r.bottom || at[1] > r.top())
      continue;
    const double radius = 0.5 * marker.size * pixel;
    canvas.disc(at, radius + 2 * pixel, white);
    canvas.disc(at, radius, marker.colour);
    if (marker.label.empty())
      continue;
    // To the right of the marker, or to its left where the picture ends; on a white ground to be read on any
    // colour.
    const double width = canvas.text_width(marker.label, font), gap = radius + 10 * pixel;
    const bool fits = at[0] + gap + width < layout.size[0] - 8 * pixel;
    const double left = fits ? at[0] + gap : at[0] - gap - width;
    canvas.rectangle({left - 5 * pixel, at[1] - 0.62 * font, width + 10 * pixel, 1.24 * font}, white);
    canvas.text(marker.label, {left, at[1]}, font, HorizontalAlign::left, VerticalAlign::middle,
                marker.colour);
  }
}

} // namespace cdem
