#include "libcdem/vtk/view.hpp"

#include "libcdem/vtk/labels.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace cdem {

using geom::Vec3;

View View::named(const std::string& view, const std::string& up) {
  if (up != "y" && up != "z")
    throw geom::InputError("up", '"' + up + '"', "\"y\" or \"z\"");
  struct Axes {
    Vec3 toward, up;
  };
  static const std::map<std::string, Axes> views = {
      {"front", {{0, 0, 1}, {0, 1, 0}}},   {"back", {{0, 0, -1}, {0, 1, 0}}},
      {"left", {{-1, 0, 0}, {0, 1, 0}}},   {"right", {{1, 0, 0}, {0, 1, 0}}},
      {"top", {{0, 1, 0}, {0, 0, -1}}},    {"bottom", {{0, -1, 0}, {0, 0, 1}}},
      {"iso", {{0.75, 0.6, 1}, {0, 1, 0}}}};
  const auto chosen = views.find(view);
  if (chosen == views.end())
    throw geom::InputError("view", '"' + view + '"', "front, back, left, right, top, bottom or iso");
  Axes axes = chosen->second;
  if (up == "z") // turn the viewer by 90 degrees about x: y becomes z, z becomes -y
    for (Vec3* v : {&axes.toward, &axes.up})
      *v = Vec3(v->x(), -v->z(), v->y());
  View result;
  result.toward = axes.toward.normalized();
  result.right = axes.up.cross(result.toward).normalized();
  result.up = result.toward.cross(result.right);
  return result;
}

namespace {

// The part of the surface that looks upwards and is seen, m2 as projected. A depth buffer tells what stands in front of it.
double seen_from_above(const View& view, const Vec3& vertical, const std::vector<Vec3>& points,
                       const std::vector<geom::Triangle>& surface) {
  constexpr int cells_along = 200; // of the longer side
  constexpr double upwards = 0.05; // of a unit normal along the upward axis
  const geom::Box box = view.extent(points);
  const double cell = std::max(box.size().x(), box.size().y()) / cells_along;
  if (!(cell > 0))
    return 0;
  const std::array<int, 2> count{static_cast<int>(box.size().x() / cell) + 1,
                                 static_cast<int>(box.size().y() / cell) + 1};
  struct Cell {
    double depth = -std::numeric_limits<double>::infinity(); // m, towards the viewer
    bool upwards = false;
  };
  std::vector<Cell> cells(static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]));
  for (const geom::Triangle& t : surface) {
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = view.in_view(points[static_cast<std::size_t>(t[k])]);
    const auto twice_area = [](const Vec3& a, const Vec3& b, const Vec3& c) {
      return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    };
    const double whole = twice_area(x[0], x[1], x[2]);
    if (!(whole > 0)) // it looks away
      continue;
    const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    const bool up = normal.dot(view.in_view(vertical)) > upwards;
    std::array<int, 2> first{}, last{};
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::minmax({x[0][axis], x[1][axis], x[2][axis]});
      first[axis] = std::max(0, static_cast<int>(std::ceil((low - box.min[axis]) / cell - 0.5)));
      last[axis] =
          std::min(count[axis] - 1, static_cast<int>(std::floor((high - box.min[axis]) / cell - 0.5)));
    }
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) {
        const Vec3 p(box.min.x() + (i + 0.5) * cell, box.min.y() + (j + 0.5) * cell, 0);
        const double a = twice_area(p, x[1], x[2]), b = twice_area(x[0], p, x[2]),
                     c = twice_area(x[0], x[1], p);
        if (std::min({a, b, c}) < 0)
          continue;
        Cell& here = cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(count[0]) +
                           static_cast<std::size_t>(i)];
        if (const double depth = (a * x[0].z() + b * x[1].z() + c * x[2].z()) / whole; depth > here.depth)
          here = {depth, up};
      }
  }
  return cell * cell * static_cast<double>(std::count_if(cells.begin(), cells.end(), [](const Cell& c) {
           return c.upwards;
         }));
}

} // namespace

View View::iso(const std::string& up, const std::vector<Vec3>& points,
               const std::vector<geom::Triangle>& surface) {
  constexpr double hardly = 1.5; // times what the usual corner shows
  const Vec3 vertical = up == "z" ? Vec3::UnitZ() : Vec3::UnitY();
  const View usual = named("iso", up);
  View best = usual;
  double most = 0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::AngleAxisd turn(quarter * M_PI / 2, vertical);
    View view = usual;
    view.toward = turn * usual.toward;
    view.right = turn * usual.right;
    view.up = turn * usual.up;
    const double shown = seen_from_above(view, vertical, points, surface);
    if (shown <= (quarter == 0 ? 0 : hardly * most))
      continue;
    most = shown;
    best = view;
  }
  return best;
}

View View::from(const Camera& camera) {
  for (const auto& [name, v] : {std::pair<const char*, Vec3>{"camera.position", camera.position},
                                {"camera.focal_point", camera.focal_point},
                                {"camera.up", camera.up}})
    geom::require_finite(name, v);
  if (!(camera.view_angle > 0.1 && camera.view_angle < 150))
    throw geom::InputError("camera.view_angle", geom::text(camera.view_angle), "between 0.1 and 150 degrees");
  View result;
  const Vec3 arm = camera.position - camera.focal_point;
  if (!(arm.norm() > 0))
    throw geom::InputError("camera.position", geom::text(camera.position), "away from camera.focal_point");
  result.toward = arm.normalized();
  const Vec3 right = camera.up.cross(result.toward);
  if (!(right.norm() > 1e-9 * camera.up.norm()))
    throw geom::InputError("camera.up", geom::text(camera.up), "not along the line of sight");
  result.right = right.normalized();
  result.up = result.toward.cross(result.right);
  result.focal_point = camera.focal_point;
  result.distance = arm.norm();
  result.view_angle = camera.view_angle;
  result.perspective = camera.perspective;
  result.literal = true;
  return result;
}

geom::Box View::extent(const std::vector<Vec3>& points) const {
  geom::Box box;
  for (const Vec3& x : points)
    box.extend(in_view(x));
  return box;
}

geom::Box View::extent(const geom::Box& all) const {
  geom::Box box;
  for (const double x : {all.min.x(), all.max.x()})
    for (const double y : {all.min.y(), all.max.y()})
      for (const double z : {all.min.z(), all.max.z()})
        box.extend(in_view({x, y, z}));
  return box;
}

View view_of(const PictureOptions& options, const std::vector<Vec3>& points,
             const std::vector<geom::Triangle>& surface) {
  return options.camera          ? View::from(*options.camera)
         : options.view == "iso" ? View::iso(options.up, points, surface)
                                 : View::named(options.view, options.up);
}

void View::fit(const geom::Box& extent_in_view, const Rect& target, double inset) {
  frame = target;
  const Vec3 size = extent_in_view.size(), middle = extent_in_view.centre();
  metres_per_pixel = std::max(size.x() / (target.width - 2 * inset), size.y() / (target.height - 2 * inset));
  if (!(metres_per_pixel > 0)) // a single point
    metres_per_pixel = 1;
  focal_point = middle.x() * right + middle.y() * up + middle.z() * toward;
  distance = 2 * std::max(size.norm(), metres_per_pixel);
}

void View::place(const Rect& target) {
  frame = target;
  metres_per_pixel = 2 * distance * std::tan(view_angle * M_PI / 360) / target.height;
}

double View::pixel_size(const Vec3& x) const {
  return perspective ? metres_per_pixel * (distance - toward.dot(x - focal_point)) / distance
                     : metres_per_pixel;
}

bool View::in_front(const Vec3& x) const {
  return !perspective || toward.dot(x - focal_point) < 0.999 * distance;
}

std::array<double, 2> View::pixel(const Vec3& x) const {
  const Vec3 r = x - focal_point;
  const double size = pixel_size(x);
  return {frame.centre_x() + right.dot(r) / size, frame.centre_y() + up.dot(r) / size};
}

Vec3 View::direction_to_viewer(const Vec3& x) const {
  return perspective ? Vec3((focal_point + distance * toward - x).normalized()) : toward;
}

} // namespace cdem
