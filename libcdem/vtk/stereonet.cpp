#include "libcdem/vtk/stereonet.hpp"

#include "libcdem/vtk/canvas.hpp"
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/layout.hpp"
#include "libcdem/vtk/save_drawing.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr Colour net_colour = {0.88, 0.88, 0.88}, rim_colour = {0.35, 0.35, 0.35};
constexpr double net_margin = 36, rim_line = 3, net_line = 1.5, tick_long = 22, tick_short = 12,
                 arc_line = 4.5, pole_size = 15, sample = 70, sample_room = 14;
constexpr int circle_points = 181;
constexpr double deg = M_PI / 180;

// As a compass has it: 7 degrees are "007" with three digits.
std::string digits(double angle, std::size_t count) {
  const std::string text = std::to_string(std::lround(angle / deg));
  return std::string(count - std::min(count, text.size()), '0') + text;
}

class NetDrawing {
public:
  NetDrawing(const std::vector<StereonetPoles>& poles, const std::vector<StereonetPlane>& planes,
             const StereonetOptions& options)
      : poles_(poles), planes_(planes), options_(options),
        pixel_(std::min(options.size[0] / 1600., options.size[1] / 1200.)), font_(label_font * pixel_) {}

  void draw(const std::string& path) {
    place_net();
    draw_net();
    for (std::size_t i = 0; i < planes_.size(); ++i)
      canvas_.polyline(on_paper(geom::great_circle_on_net(planes_[i].plane, circle_points)),
                       arc_line * pixel_, plane_colour(i), planes_[i].dashed);
    draw_poles();
    draw_legend();
    if (!options_.title.empty()) {
      const double room = options_.size[0] - 40 * pixel_,
                   wanted = canvas_.text_width(options_.title, title_font * pixel_);
      canvas_.text(
          options_.title,
          {0.5 * options_.size[0], options_.size[1] - net_margin * pixel_ - 0.9 * title_font * pixel_},
          title_font * pixel_ * std::min(1., room / std::max(wanted, 1.)), HorizontalAlign::centre,
          VerticalAlign::baseline);
    }
    save_drawing(options_.size, options_.dpi, {}, canvas_, path);
  }

private:
  Colour pole_colour(std::size_t i) const { return poles_[i].colour.value_or(palette_colour(i)); }
  std::optional<std::size_t> poles_of(std::size_t plane) const { // of the same name
    const auto own = std::find_if(poles_.begin(), poles_.end(), [&](const StereonetPoles& poles) {
      return poles.name == planes_[plane].name;
    });
    return own == poles_.end() ? std::nullopt : std::optional<std::size_t>(own - poles_.begin());
  }
  Colour plane_colour(std::size_t i) const {
    if (planes_[i].colour)
      return *planes_[i].colour;
    if (const auto poles = poles_of(i))
      return pole_colour(*poles);
    std::size_t next = poles_.size();
    for (std::size_t before = 0; before < i; ++before)
      next += poles_of(before) ? 0 : 1;
    return palette_colour(next);
  }
  std::string pole_text(std::size_t i) const {
    const std::size_t n = poles_[i].planes.size();
    return poles_[i].name + " (" + geom::counted(n, "pole") + ")";
  }
  std::string angles(std::size_t plane) const {
    const geom::Orientation& o = planes_[plane].plane;
    return digits(o.dip, 2) + "/" + digits(o.dip_direction, 3);
  }
  std::string plane_text(std::size_t i) const {
    const std::string& name = planes_[i].name;
    return name.find(angles(i)) != std::string::npos ? name : name + " (" + angles(i) + ")";
  }

  struct Entry {
    std::string text;
    std::optional<std::size_t> poles{}, plane{};
  };
  // Poles and the plane of their name share a row.
  std::vector<Entry> rows() const {
    std::vector<Entry> all;
    for (std::size_t i = 0; i < poles_.size(); ++i)
      all.push_back({pole_text(i), i});
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const auto poles = poles_of(i);
      if (!poles || all[*poles].plane || plane_colour(i) != pole_colour(*poles)) {
        all.push_back({plane_text(i), {}, i});
        continue;
      }
      all[*poles].plane = i;
      all[*poles].text.insert(all[*poles].text.size() - 1, ", " + angles(i));
    }
    return all;
  }
  static std::vector<std::string> texts(const std::vector<Entry>& rows) {
    std::vector<std::string> all;
    all.reserve(rows.size());
    for (const Entry& row : rows)
      all.push_back(row.text);
    return all;
  }
  Canvas::Point on_paper(const Eigen::Vector2d& x) const {
    return {centre_[0] + radius_ * x.x(), centre_[1] + radius_ * x.y()};
  }
  std::vector<Canvas::Point> on_paper(const std::vector<Eigen::Vector2d>& line) const {
    std::vector<Canvas::Point> points;
    points.reserve(line.size());
    for (const Eigen::Vector2d& x : line)
      points.push_back(on_paper(x));
    return points;
  }
  void circle(double radius, double width, const Colour& colour) {
    std::vector<Canvas::Point> points;
    for (int i = 0; i < 2 * circle_points; ++i) {
      const double angle = 2 * M_PI * i / (2 * circle_points - 1);
      points.push_back(on_paper({radius * std::sin(angle), radius * std::cos(angle)}));
    }
    canvas_.polyline(points, width * pixel_, colour);
  }

  // The legend stands to the right of the net, or below it in a picture that is higher than wide. Its text becomes
  // smaller where it must.
  void place_net() {
    const double s = pixel_, rim = 1.7 * font_ + tick_long * s; // rim: letters around the net
    const double wide = options_.size[0], top = options_.size[1] - net_margin * s -
                                                (options_.title.empty() ? 0 : 1.6 * title_font * s);
    const double bottom = net_margin * s + 1.5 * font_; // a line of text below the net
    const double highest = options_.size[1] > wide ? 0.5 * (top - bottom) : top - net_margin * s;
    row_ = std::min(1.5 * font_, highest / static_cast<double>(rows().size()));
    const double text = canvas_.widest(texts(rows()), font_), samples = (sample + sample_room) * s,
                 high = row_ * static_cast<double>(rows().size());
    if (options_.size[1] > wide) {
      const double low = bottom + std::min(high + net_margin * s, 0.5 * (top - bottom));
      radius_ = std::max(16., 0.5 * std::min(wide - net_margin * s, top - low) - rim);
      const double used = top - low - 2 * (radius_ + rim);
      centre_ = {0.5 * wide, top - 0.5 * used - radius_ - rim};
      legend_left_ = std::max(0.5 * net_margin * s, 0.5 * (wide - text - samples));
      legend_top_ = centre_[1] - radius_ - rim - 1.5 * 1.5 * font_;
    } else {
      const double legend = samples + 2 * net_margin * s + text,
                   least = 0.45 * wide; // least: width for the net
      radius_ = std::max(16., 0.5 * std::min(std::max(least, wide - legend), top - bottom) - rim);
      centre_ = {std::max(0., 0.5 * (wide - 2 * (radius_ + rim) - legend)) + radius_ + rim,
                 0.5 * (bottom + top)};
      legend_left_ = centre_[0] + radius_ + rim + net_margin * s;
      legend_top_ = std::min(centre_[1] + 0.5 * high, top);
    }
    const double room = wide - legend_left_ - samples - 0.5 * net_margin * s;
    legend_font_ = std::min(font_ * std::min(1., room / std::max(1., text)), row_ / 1.2);
  }

  void draw_net() {
    for (const double dip : {30., 60.})
      circle(std::sqrt(2.) * std::sin(0.5 * dip * deg), net_line, net_colour);
    for (int azimuth = 0; azimuth < 180; azimuth += 30) {
      const Eigen::Vector2d end(std::sin(azimuth * deg), std::cos(azimuth * deg));
      canvas_.line(on_paper(end), on_paper(-end), net_line * pixel_, net_colour);
    }
    for (const double dip : {30., 60.})
      canvas_.text(digits(dip * deg, 2) + "\u00b0",
                   on_paper(std::sqrt(2.) * std::sin(0.5 * dip * deg) *
                            Eigen::Vector2d(std::sin(15 * deg), std::cos(15 * deg))),
                   0.7 * font_, HorizontalAlign::centre, VerticalAlign::middle, rim_colour);
    circle(1, rim_line, rim_colour);
    for (int azimuth = 0; azimuth < 360; azimuth += 10) {
      const Eigen::Vector2d out(std::sin(azimuth * deg), std::cos(azimuth * deg));
      const double length = (azimuth % 90 == 0 ? tick_long : tick_short) * pixel_;
      canvas_.line(on_paper(out), on_paper((1 + length / radius_) * out), rim_line * pixel_, rim_colour);
    }
    const double beyond = 1 + (tick_long * pixel_ + 0.75 * font_) / radius_;
    for (const auto& [name, x, y] :
         {std::tuple("N", 0, 1), std::tuple("E", 1, 0), std::tuple("S", 0, -1), std::tuple("W", -1, 0)})
      canvas_.text(name, on_paper(beyond * Eigen::Vector2d(x, y)), font_, HorizontalAlign::centre,
                   VerticalAlign::middle);
    canvas_.text("equal area, lower hemisphere",
                 {centre_[0], centre_[1] - radius_ - tick_long * pixel_ - 2.6 * font_}, 0.8 * font_,
                 HorizontalAlign::centre, VerticalAlign::baseline, rim_colour);
  }

  void disc(const Canvas::Point& at, const Colour& colour) {
    canvas_.disc(at, 0.5 * pole_size * pixel_ + 2 * pixel_, {1, 1, 1});
    canvas_.disc(at, 0.5 * pole_size * pixel_, colour);
  }

  void draw_poles() {
    for (std::size_t i = 0; i < poles_.size(); ++i)
      for (const geom::Orientation& plane : poles_[i].planes)
        disc(on_paper(geom::pole_on_net(plane)), pole_colour(i));
  }

  void draw_legend() {
    const double length = sample * pixel_;
    double y = legend_top_ - 0.5 * row_;
    for (const Entry& row : rows()) {
      if (row.plane)
        canvas_.polyline({{legend_left_, y}, {legend_left_ + length, y}}, arc_line * pixel_,
                         plane_colour(*row.plane), planes_[*row.plane].dashed);
      if (row.poles)
        disc({legend_left_ + 0.5 * length, y}, pole_colour(*row.poles));
      canvas_.text(row.text, {legend_left_ + length + sample_room * pixel_, y}, legend_font_,
                   HorizontalAlign::left, VerticalAlign::middle);
      y -= row_;
    }
  }

  const std::vector<StereonetPoles>& poles_;
  const std::vector<StereonetPlane>& planes_;
  const StereonetOptions& options_;
  double pixel_, font_;
  Canvas canvas_;
  Canvas::Point centre_{0, 0}; // pixels
  double radius_ = 0, legend_left_ = 0, legend_top_ = 0, legend_font_ = 0, row_ = 0;
};

} // namespace

void stereonet(const std::vector<StereonetPoles>& poles, const std::vector<StereonetPlane>& planes,
               const StereonetOptions& options, const std::string& path) {
  check_drawing(options.size, options.dpi, path);
  if (poles.empty() && planes.empty())
    throw geom::InputError("stereonet", "nothing", "poles or planes to draw");
  NetDrawing(poles, planes, options).draw(path);
}

} // namespace cdem
