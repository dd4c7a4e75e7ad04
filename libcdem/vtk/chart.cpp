// Charts are drawn with the canvas of the pictures rather than with VTK's chart classes, which know no sub-
// and superscripts in labels and no dashes of a given length: both kinds of picture then look alike on a
// page.
#include "libcdem/vtk/chart.hpp"

#include "libcdem/vtk/canvas.hpp"
#include "libcdem/vtk/chart_axis.hpp"
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/labels.hpp"
#include "libcdem/vtk/layout.hpp"
#include "libcdem/vtk/save_drawing.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr Colour grid_colour = {0.88, 0.88, 0.88}, frame_colour = {0.35, 0.35, 0.35},
                 mark_colour = {0.45, 0.45, 0.45};
constexpr double chart_margin = 36, chart_tick = 10, minor_length = 6, chart_gap = 10, chart_line = 4.5,
                 point_size = 15;
constexpr double sample_length = 70, sample_gap = 14, entry_gap = 54;

void check(const std::vector<Series>& series, const ChartOptions& options) {
  if (series.empty())
    throw geom::InputError("series", "none", "at least one");
  for (const Series& s : series) {
    if (s.x.size() != s.y.size())
      throw geom::InputError("series \"" + s.name + "\"",
                             std::to_string(s.x.size()) + " x and " + std::to_string(s.y.size()) + " y",
                             "as many x as y");
    if (s.style != "line" && s.style != "dashed" && s.style != "points" && s.style != "both")
      throw geom::InputError("style", '"' + s.style + '"', "line, dashed, points or both");
  }
  for (const char* known : {"auto", "top_left", "top_right", "bottom_left", "bottom_right", "none"})
    if (options.legend == known)
      return;
  throw geom::InputError("legend", '"' + options.legend + '"',
                         "auto, top_left, top_right, bottom_left, bottom_right or none");
}

bool has_points(const Series& s) {
  return s.style == "points" || s.style == "both";
}
bool has_line(const Series& s) {
  return s.style != "points";
}

std::vector<double> gather(const std::vector<Series>& series, bool right_axis) {
  std::vector<double> values;
  for (const Series& s : series)
    if (s.right_axis == right_axis)
      values.insert(values.end(), s.y.begin(), s.y.end());
  return values;
}

// The part of a segment inside the rectangle (Liang and Barsky 1984); false when there is none.
bool clip(Canvas::Point& a, Canvas::Point& b, const Rect& r) {
  const double d[2] = {b[0] - a[0], b[1] - a[1]};
  const double low[2] = {r.left, r.bottom}, high[2] = {r.right(), r.top()};
  double enter = 0, leave = 1;
  for (int k = 0; k < 2; ++k)
    for (const bool upper : {false, true}) {
      const double p = upper ? d[k] : -d[k], q = upper ? high[k] - a[k] : a[k] - low[k];
      if (p == 0 && q < 0)
        return false;
      if (p < 0)
        enter = std::max(enter, q / p);
      else if (p > 0)
        leave = std::min(leave, q / p);
    }
  if (enter > leave)
    return false;
  const Canvas::Point from = a;
  a = {from[0] + enter * d[0], from[1] + enter * d[1]};
  b = {from[0] + leave * d[0], from[1] + leave * d[1]};
  return true;
}

std::string shown_label(const std::string& label, const ChartAxis& axis) {
  return axis.unit.empty() ? label : with_unit(label, axis.unit);
}

class ChartDrawing {
public:
  ChartDrawing(const std::vector<Series>& series, const ChartOptions& options);
  void draw(const std::string& path);

private:
  Colour colour(std::size_t i) const { return series_[i].colour.value_or(palette_colour(i)); }
  // Two axes with one line each wear the colours of their lines.
  Colour axis_colour(bool right) const;
  double entry_width(std::size_t i) const {
    return (sample_length + sample_gap) * pixel_ + canvas_.text_width(series_[i].name, font_);
  }
  std::vector<std::size_t> named() const;
  std::vector<std::vector<std::size_t>> legend_rows() const; // above the plot
  void place_plot();
  void draw_axes();
  void draw_vertical_axis(const ChartAxis&, bool right, const std::string& label);
  void draw_marks();
  void draw_series(std::size_t);
  void draw_run(std::vector<Canvas::Point>& points, const Series&, const Colour&);
  void draw_entry(std::size_t, double x, double y);
  void draw_legend();

  const std::vector<Series>& series_;
  const ChartOptions& options_;
  double pixel_, font_;
  Canvas canvas_;
  ChartAxis x_, left_, right_;
  bool any_right_ = false;
  Rect plot_;
};

ChartDrawing::ChartDrawing(const std::vector<Series>& series, const ChartOptions& options)
    : series_(series), options_(options), pixel_(std::min(options.size[0] / 1600., options.size[1] / 1200.)),
      font_(label_font * pixel_) {
  std::vector<double> all_x;
  bool points = false;
  for (const Series& s : series) {
    all_x.insert(all_x.end(), s.x.begin(), s.x.end());
    points = points || has_points(s);
    any_right_ = any_right_ || s.right_axis;
  }
  const int across = std::max(3, static_cast<int>(options.size[0] / pixel_ / 200));
  const int upward = std::max(3, static_cast<int>(options.size[1] / pixel_ / 170));
  x_ = chart_axis(all_x, options.log_x, points, across, options.x_range, "x_range",
                  unit_of_label(options.x_label));
  left_ = chart_axis(gather(series, false), options.log_y, true, upward, options.y_range, "y_range",
                     unit_of_label(options.y_label));
  right_ = chart_axis(gather(series, true), options.log_right, true, upward, options.right_range,
                      "right_range", unit_of_label(options.right_label));
}

Colour ChartDrawing::axis_colour(bool right) const {
  const auto on_right =
      std::count_if(series_.begin(), series_.end(), [](const Series& s) { return s.right_axis; });
  if (series_.size() != 2 || on_right != 1)
    return black;
  return series_[0].right_axis == right ? colour(0) : colour(1);
}

std::vector<std::size_t> ChartDrawing::named() const {
  std::vector<std::size_t> entries;
  for (std::size_t i = 0; i < series_.size(); ++i)
    if (!series_[i].name.empty())
      entries.push_back(i);
  return entries;
}

std::vector<std::vector<std::size_t>> ChartDrawing::legend_rows() const {
  std::vector<std::vector<std::size_t>> rows;
  if (options_.legend != "auto")
    return rows;
  const double room = options_.size[0] - 2 * chart_margin * pixel_;
  double used = 0;
  for (const std::size_t i : named()) {
    const double width = entry_width(i) + entry_gap * pixel_;
    if (rows.empty() || used + width - entry_gap * pixel_ > room) {
      rows.emplace_back();
      used = 0;
    }
    rows.back().push_back(i);
    used += width;
  }
  return rows;
}

void ChartDrawing::place_plot() {
  const double s = pixel_, row = 1.5 * font_;
  const double ticks = (chart_tick + chart_gap) * s;
  double left = chart_margin * s + ticks + canvas_.widest(left_.labels, font_);
  if (!options_.y_label.empty())
    left += 1.6 * font_;
  double right =
      chart_margin * s + 0.5 * canvas_.text_width(x_.labels.empty() ? "" : x_.labels.back(), font_);
  if (any_right_) {
    right = chart_margin * s + ticks + canvas_.widest(right_.labels, font_);
    if (!options_.right_label.empty())
      right += 1.6 * font_;
  }
  double bottom = chart_margin * s + ticks + 0.8 * font_;
  if (!options_.x_label.empty() || !x_.multiplier.empty())
    bottom += 1.6 * font_;
  double top = chart_margin * s + 0.4 * font_;
  if (!options_.title.empty())
    top += 1.6 * title_font * s;
  top += row * static_cast<double>(legend_rows().size());
  if (!left_.multiplier.empty() || (any_right_ && !right_.multiplier.empty()))
    top += 1.2 * font_;
  plot_ = {std::round(left), std::round(bottom), std::round(std::max(32., options_.size[0] - left - right)),
           std::round(std::max(32., options_.size[1] - bottom - top))};
}

void ChartDrawing::draw_vertical_axis(const ChartAxis& axis, bool right, const std::string& label) {
  const double s = pixel_, x = right ? plot_.right() : plot_.left, out = right ? 1 : -1;
  const Colour ink = axis_colour(right);
  for (const auto* ticks : {&axis.major, &axis.minor})
    for (const double tick : *ticks) {
      const double y = plot_.bottom + axis.place(tick) * plot_.height;
      const double length = (ticks == &axis.major ? chart_tick : minor_length) * s;
      canvas_.line({x, y}, {x + out * length, y}, 2 * s, frame_colour);
    }
  for (std::size_t i = 0; i < axis.major.size(); ++i)
    canvas_.text(
        axis.labels[i],
        {x + out * (chart_tick + chart_gap) * s, plot_.bottom + axis.place(axis.major[i]) * plot_.height},
        font_, right ? HorizontalAlign::left : HorizontalAlign::right, VerticalAlign::middle, ink);
  if (!axis.multiplier.empty())
    canvas_.text(axis.multiplier, {x, plot_.top() + 0.5 * font_}, font_,
                 right ? HorizontalAlign::right : HorizontalAlign::left, VerticalAlign::baseline, ink);
  if (label.empty())
    return;
  const double edge =
      right ? options_.size[0] - chart_margin * s - 0.05 * font_ : chart_margin * s + 0.75 * font_;
  canvas_.text(shown_label(label, axis), {edge, plot_.centre_y()}, font_, HorizontalAlign::centre,
               VerticalAlign::baseline, ink, 90);
}

void ChartDrawing::draw_axes() {
  const double s = pixel_;
  for (const double tick : x_.major) {
    const double x = plot_.left + x_.place(tick) * plot_.width;
    canvas_.line({x, plot_.bottom}, {x, plot_.top()}, 1.5 * s, grid_colour);
  }
  for (const double tick : left_.major) {
    const double y = plot_.bottom + left_.place(tick) * plot_.height;
    canvas_.line({plot_.left, y}, {plot_.right(), y}, 1.5 * s, grid_colour);
  }
  canvas_.frame(plot_, 2 * s, frame_colour);
  for (const auto* ticks : {&x_.major, &x_.minor})
    for (const double tick : *ticks) {
      const double x = plot_.left + x_.place(tick) * plot_.width;
      const double length = (ticks == &x_.major ? chart_tick : minor_length) * s;
      canvas_.line({x, plot_.bottom}, {x, plot_.bottom - length}, 2 * s, frame_colour);
    }
  const double under = plot_.bottom - (chart_tick + chart_gap) * s;
  for (std::size_t i = 0; i < x_.major.size(); ++i)
    canvas_.text(x_.labels[i], {plot_.left + x_.place(x_.major[i]) * plot_.width, under}, font_,
                 HorizontalAlign::centre, VerticalAlign::top);
  const double label_line = chart_margin * s + 0.1 * font_;
  canvas_.text(shown_label(options_.x_label, x_), {plot_.centre_x(), label_line}, font_,
               HorizontalAlign::centre, VerticalAlign::baseline);
  canvas_.text(x_.multiplier, {plot_.right(), label_line}, font_, HorizontalAlign::right,
               VerticalAlign::baseline);
  draw_vertical_axis(left_, false, options_.y_label);
  if (any_right_)
    draw_vertical_axis(right_, true, options_.right_label);
}

void ChartDrawing::draw_marks() {
  const double font = 0.8 * font_, gap = 0.4 * font;
  std::vector<std::pair<double, std::string>> shown; // place in pixels, name
  for (const ChartMark& mark : options_.marks)
    if (const double along = x_.place(mark.x); x_.holds(mark.x) && along >= 0 && along <= 1)
      shown.emplace_back(plot_.left + along * plot_.width, mark.name);
  for (std::size_t i = 0; i < shown.size();) {
    const double first = shown[i].first;
    double last = first;
    std::string names;
    for (; i < shown.size() && shown[i].first - first < 1.2 * font; ++i) {
      last = shown[i].first;
      canvas_.line({last, plot_.bottom}, {last, plot_.top()}, 2 * pixel_, mark_colour);
      names += (names.empty() ? "" : ", ") + shown[i].second;
    }
    const bool fits = last + gap + font < plot_.right(); // right of the line, else left of it
    canvas_.text(names, {fits ? last + gap + 0.75 * font : first - gap, plot_.top() - gap}, font,
                 HorizontalAlign::right, VerticalAlign::baseline, mark_colour, 90);
  }
}

void ChartDrawing::draw_run(std::vector<Canvas::Point>& points, const Series& s, const Colour& ink) {
  // Consecutive pieces that stay inside are drawn as one line with round corners.
  std::vector<Canvas::Point> piece;
  const auto finish = [&] {
    canvas_.polyline(piece, chart_line * pixel_, ink, s.style == "dashed");
    piece.clear();
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Canvas::Point a = points[i], b = points[i + 1];
    if (!clip(a, b, plot_)) {
      finish();
      continue;
    }
    if (piece.empty() || piece.back() != a) {
      finish();
      piece.push_back(a);
    }
    piece.push_back(b);
  }
  finish();
  points.clear();
}

void ChartDrawing::draw_series(std::size_t i) {
  const Series& s = series_[i];
  const ChartAxis& y_axis = s.right_axis ? right_ : left_;
  const Colour ink = colour(i);
  const auto place = [&](std::size_t k) {
    return Canvas::Point{plot_.left + x_.place(s.x[k]) * plot_.width,
                         plot_.bottom + y_axis.place(s.y[k]) * plot_.height};
  };
  if (has_line(s)) {
    std::vector<Canvas::Point> run;
    for (std::size_t k = 0; k < s.x.size(); ++k) {
      if (!x_.holds(s.x[k]) || !y_axis.holds(s.y[k])) {
        draw_run(run, s, ink);
        continue;
      }
      const Canvas::Point p = place(k);
      // A history has thousands of points; those nearer than half a pixel to the last drawn one add nothing.
      if (run.empty() || k + 1 == s.x.size() || std::hypot(p[0] - run.back()[0], p[1] - run.back()[1]) > 0.5)
        run.push_back(p);
    }
    draw_run(run, s, ink);
  }
  if (has_points(s))
    for (std::size_t k = 0; k < s.x.size(); ++k) {
      if (!x_.holds(s.x[k]) || !y_axis.holds(s.y[k]))
        continue;
      const Canvas::Point p = place(k);
      const double slack = 0.5;
      if (p[0] < plot_.left - slack || p[0] > plot_.right() + slack || p[1] < plot_.bottom - slack ||
          p[1] > plot_.top() + slack)
        continue;
      canvas_.disc(p, 0.5 * point_size * pixel_ + 2 * pixel_, {1, 1, 1});
      canvas_.disc(p, 0.5 * point_size * pixel_, ink);
    }
}

void ChartDrawing::draw_entry(std::size_t i, double x, double y) {
  const Series& s = series_[i];
  const double length = sample_length * pixel_;
  if (has_line(s))
    canvas_.polyline({{x, y}, {x + length, y}}, chart_line * pixel_, colour(i), s.style == "dashed");
  if (has_points(s))
    canvas_.disc({x + 0.5 * length, y}, 0.5 * point_size * pixel_, colour(i));
  canvas_.text(s.name, {x + length + sample_gap * pixel_, y}, font_, HorizontalAlign::left,
               VerticalAlign::middle);
}

void ChartDrawing::draw_legend() {
  const double row = 1.5 * font_;
  if (options_.legend == "auto") {
    const auto rows = legend_rows();
    const bool multiplier = !left_.multiplier.empty() || (any_right_ && !right_.multiplier.empty());
    double y =
        plot_.top() + (multiplier ? 1.2 * font_ : 0) + row * static_cast<double>(rows.size()) - 0.25 * font_;
    for (const auto& entries : rows) {
      double width = -entry_gap * pixel_;
      for (const std::size_t i : entries)
        width += entry_width(i) + entry_gap * pixel_;
      const double room = options_.size[0] - chart_margin * pixel_;
      double x = std::max(chart_margin * pixel_, std::min(plot_.centre_x() - 0.5 * width, room - width));
      for (const std::size_t i : entries) {
        draw_entry(i, x, y);
        x += entry_width(i) + entry_gap * pixel_;
      }
      y -= row;
    }
    return;
  }
  const std::vector<std::size_t> entries = named();
  if (options_.legend == "none" || entries.empty())
    return;
  double width = 0;
  for (const std::size_t i : entries)
    width = std::max(width, entry_width(i));
  const double pad = 0.6 * font_, gap = 0.5 * font_;
  Rect box{0, 0, width + 2 * pad, row * static_cast<double>(entries.size()) + pad};
  box.left =
      options_.legend.find("left") != std::string::npos ? plot_.left + gap : plot_.right() - gap - box.width;
  box.bottom =
      options_.legend.find("top") != std::string::npos ? plot_.top() - gap - box.height : plot_.bottom + gap;
  canvas_.rectangle(box, {1, 1, 1});
  canvas_.frame(box, 1.5 * pixel_, grid_colour);
  double y = box.top() - 0.5 * pad - 0.5 * row;
  for (const std::size_t i : entries) {
    draw_entry(i, box.left + pad, y);
    y -= row;
  }
}

void ChartDrawing::draw(const std::string& path) {
  place_plot();
  draw_axes();
  draw_marks();
  for (std::size_t i = 0; i < series_.size(); ++i)
    draw_series(i);
  draw_legend();
  if (!options_.title.empty()) {
    const double room = options_.size[0] - 40 * pixel_;
    const double wanted = canvas_.text_width(options_.title, title_font * pixel_);
    const double half = 0.5 * std::min(wanted, room);
    canvas_.text(options_.title,
                 {std::clamp(plot_.centre_x(), 20 * pixel_ + half, options_.size[0] - 20 * pixel_ - half),
                  options_.size[1] - chart_margin * pixel_ - 0.9 * title_font * pixel_},
                 title_font * pixel_ * std::min(1., room / std::max(wanted, 1.)), HorizontalAlign::centre,
                 VerticalAlign::baseline);
  }
  save_drawing(options_.size, options_.dpi, {}, canvas_, path);
}

} // namespace

void chart(const std::vector<Series>& series, const ChartOptions& options, const std::string& path) {
  check_drawing(options.size, options.dpi, path);
  check(series, options);
  ChartDrawing(series, options).draw(path);
}

} // namespace cdem
