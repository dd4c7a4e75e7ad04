#include "libcdem/vtk/water_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem {
namespace {

using geom::Vec3;
using Corners = std::array<Vec3, 3>;

constexpr double largest_part = 0.7; // edge of a part of a triangle over the cell of the sheet
constexpr int most_halvings = 16;
constexpr double longest_arrow = 0.055;   // of the sheet's longer side
constexpr std::size_t most_samples = 200; // places of a sheet that are looked for
constexpr double edge_on = 0.02;          // sine of the angle below which a sheet is seen as a line
constexpr double shortest_arrow = 0.03;   // of the longest; shorter ones are left out

// Where a function that is linear over a triangle changes its sign.
template <class Height>
void add_zero_line(const Corners& x, const Height& h, std::vector<Segment>& lines) {
  std::array<double, 3> height;
  for (std::size_t k = 0; k < 3; ++k)
    if (height[k] = h(x[k]); std::isnan(height[k]))
      return;
  std::vector<Vec3> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = height[k], b = height[(k + 1) % 3];
    if ((a >= 0) != (b >= 0))
      ends.push_back(x[k] + a / (a - b) * (x[(k + 1) % 3] - x[k]));
  }
  if (ends.size() == 2)
    lines.push_back({ends[0], ends[1]});
}

class Cutter {
public:
  Cutter(const WaterSheet& sheet, std::vector<Segment>& lines)
      : sheet_(sheet), largest_(largest_part * std::max(sheet.cell[0], sheet.cell[1])), lines_(lines) {
    for (const double z : sheet.height)
      if (!std::isnan(z)) {
        low_ = std::min(low_, z);
        high_ = std::max(high_, z);
      }
  }
  void cut(const Corners& x, int halvings = 0) {
    const auto [low, high] = std::minmax({x[0].z(), x[1].z(), x[2].z()});
    if (low > high_ || high < low_)
      return;
    std::size_t longest = 0;
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (const double edge = (x[(k + 1) % 3] - x[k]).head<2>().norm(); edge > length) {
        length = edge;
        longest = k;
      }
    if (length <= largest_ || halvings == most_halvings) {
      add_zero_line(
          x, [&](const Vec3& p) { return p.z() - sheet_.height_at(p.x(), p.y()); }, lines_);
      return;
    }
    const Vec3 &a = x[longest], &b = x[(longest + 1) % 3], &c = x[(longest + 2) % 3], middle = 0.5 * (a + b);
    cut({a, middle, c}, halvings + 1);
    cut({middle, b, c}, halvings + 1);
  }

private:
  const WaterSheet& sheet_;
  double largest_, low_ = 1e300, high_ = -1e300; // m
  std::vector<Segment>& lines_;
};

// Polygons and lines over points, cut at the sides of a rectangle of x and y (Sutherland and Hodgman 1974).
class Cropper {
public:
  Cropper(const geom::Box& box, std::vector<Vec3>& points) : box_(box), points_(points) {}

  bool outside(const Vec3& x) const {
    for (int side = 0; side < 4; ++side)
      if (beyond(x, side) > 0)
        return true;
    return false;
  }
  std::vector<int> crop(std::vector<int> around, bool closed) {
    for (int side = 0; side < 4; ++side) {
      std::vector<int> left;
      for (std::size_t k = 0; k < around.size(); ++k) {
        const int a = around[k];
        const double at_a = beyond(points_[a], side);
        if (at_a <= 0)
          left.push_back(a);
        if (k + 1 == around.size() && !closed)
          break;
        const int b = around[(k + 1) % around.size()];
        if (const double at_b = beyond(points_[b], side); (at_a <= 0) != (at_b <= 0)) {
          left.push_back(static_cast<int>(points_.size()));
          const Vec3 cut = points_[a] + at_a / (at_a - at_b) * (points_[b] - points_[a]);
          points_.push_back(cut);
        }
      }
      around = std::move(left);
    }
    return around;
  }

private:
  double beyond(const Vec3& x, int side) const { // m
    const int axis = side / 2;
    return side % 2 == 0 ? box_.min[axis] - x[axis] : x[axis] - box_.max[axis];
  }
  const geom::Box& box_;
  std::vector<Vec3>& points_;
};

bool inside(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) { // in the plane of the triangle
  const Vec3 n = (b - a).cross(c - a);
  const double size = n.squaredNorm();
  return size > 0 && (b - a).cross(x - a).dot(n) >= 0 && (c - b).cross(x - b).dot(n) >= 0 &&
         (a - c).cross(x - c).dot(n) >= 0;
}

bool in_blocks(const Snapshot& section, const Vec3& x) {
  return std::any_of(section.surface.begin(), section.surface.end(), [&](const geom::Triangle& t) {
    return inside(x, section.points[t[0]], section.points[t[1]], section.points[t[2]]);
  });
}

Polyline arrow_line(const std::vector<Vec3>& points) {
  Polyline line;
  line.points = points;
  line.colour = water_line_colour;
  line.width = 2.5;
  return line;
}

// shown(place): whether an arrow is drawn there.
template <class Shown>
std::vector<Polyline> arrows_of(const std::vector<WaterSheet>& sheets, const Shown& shown) {
  std::vector<WaterArrow> arrows;
  double most = 0, length = 0; // m/s, m
  for (const WaterSheet& sheet : sheets) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      length = std::max(length, longest_arrow * sheet.cell[axis] * (sheet.size[axis] - 1));
    for (const WaterArrow& arrow : sheet.arrows)
      if (shown(arrow.place)) {
        arrows.push_back(arrow);
        most = std::max(most, arrow.velocity.norm());
      }
  }
  std::vector<Polyline> lines;
  for (const WaterArrow& arrow : arrows) {
    const Vec3 along = length / most * arrow.velocity;
    if (!(along.norm() > shortest_arrow * length))
      continue;
    const Vec3 tip = arrow.place + along, back = tip - 0.25 * along;
    const Vec3 other = std::abs(along.y()) < 0.9 * along.norm() ? Vec3::UnitY() : Vec3::UnitX();
    const Vec3 wing = 0.1 * along.norm() * along.cross(other).normalized();
    lines.push_back(arrow_line({arrow.place, tip}));
    lines.push_back(arrow_line({back + wing, tip, back - wing}));
  }
  if (!lines.empty()) {
    char text[64];
    std::snprintf(text, sizeof text, "longest arrow %.3g m/s", most);
    lines.front().label = text;
  }
  return lines;
}

// The ray from p along `toward` crosses the triangle (Moeller and Trumbore 1997).
bool crosses(const Vec3& p, const Vec3& toward, const Corners& x) {
  const Vec3 e1 = x[1] - x[0], e2 = x[2] - x[0], h = toward.cross(e2), s = p - x[0], q = s.cross(e1);
  const double det = e1.dot(h), u = s.dot(h) / det, v = toward.dot(q) / det;
  return det != 0 && u >= 0 && v >= 0 && u + v <= 1 && e2.dot(q) / det > 0;
}

} // namespace

bool is_seen(const std::vector<WaterSheet>& sheets, const std::vector<Vec3>& points,
             const std::vector<geom::Triangle>& surface, const View& view) {
  for (const WaterSheet& sheet : sheets)
    for (std::size_t i = 0; i < sheet.triangles.size(); i += 1 + sheet.triangles.size() / most_samples) {
      const geom::Triangle& t = sheet.triangles[i];
      const Vec3 &a = sheet.points[t[0]], &b = sheet.points[t[1]], &c = sheet.points[t[2]];
      const Vec3 middle = (a + b + c) / 3, toward = view.direction_to_viewer(middle),
                 area = (b - a).cross(c - a);
      if (std::abs(area.dot(toward)) > edge_on * area.norm() &&
          std::none_of(surface.begin(), surface.end(), [&](const geom::Triangle& face) {
            return crosses(middle, toward, {points[face[0]], points[face[1]], points[face[2]]});
          }))
        return true;
    }
  return false;
}

std::vector<Segment> water_lines(const std::vector<WaterSheet>& sheets, const std::vector<Vec3>& points,
                                 const std::vector<geom::Triangle>& surface) {
  std::vector<Segment> lines;
  for (const WaterSheet& sheet : sheets) {
    if (sheet.points.empty())
      continue;
    Cutter cutter(sheet, lines);
    for (const std::array<int, 2>& e : sheet.shore)
      lines.push_back({sheet.points[e[0]], sheet.points[e[1]]});
    for (const geom::Triangle& t : surface)
      cutter.cut({points[t[0]], points[t[1]], points[t[2]]});
  }
  return lines;
}

WaterSheet cropped(const WaterSheet& all, const geom::Box& box) {
  WaterSheet part = all;
  part.triangles.clear();
  part.net.clear();
  part.shore.clear();
  part.velocity.clear();
  Cropper cropper(box, part.points);
  for (const geom::Triangle& t : all.triangles) {
    const std::vector<int> around = cropper.crop({t[0], t[1], t[2]}, true);
    for (std::size_t i = 2; i < around.size(); ++i)
      part.triangles.push_back({around[0], around[i - 1], around[i]});
  }
  const auto crop_lines = [&](const auto& lines, auto& into) {
    for (const std::array<int, 2>& e : lines)
      if (const std::vector<int> line = cropper.crop({e[0], e[1]}, false); line.size() == 2)
        into.push_back({line[0], line[1]});
  };
  crop_lines(all.net, part.net);
  crop_lines(all.shore, part.shore);
  part.arrows.erase(std::remove_if(part.arrows.begin(), part.arrows.end(),
                                   [&](const WaterArrow& a) { return cropper.outside(a.place); }),
                    part.arrows.end());
  return part;
}

std::vector<Polyline> water_in_section(const std::vector<WaterSheet>& sheets, const CutPlane& plane) {
  std::vector<Polyline> lines;
  for (const WaterSheet& sheet : sheets) {
    std::vector<Segment> segments;
    for (const geom::Triangle& t : sheet.triangles)
      add_zero_line(
          {sheet.points[t[0]], sheet.points[t[1]], sheet.points[t[2]]},
          [&](const Vec3& x) { return (x - plane.point).dot(plane.normal); }, segments);
    for (const Segment& s : segments) {
      Polyline line;
      line.points = {s[0], s[1]};
      line.colour = water_colour;
      if (lines.empty())
        line.label = "water line";
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

std::vector<Polyline> water_arrows(const std::vector<WaterSheet>& water) {
  return arrows_of(water, [](const Vec3&) { return true; });
}

std::vector<Polyline> water_arrows_in(const Snapshot& section, const std::vector<WaterSheet>& water) {
  return arrows_of(water, [&](const Vec3& x) { return !in_blocks(section, x); });
}

} // namespace cdem
