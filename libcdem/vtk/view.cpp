#include "libcdem/vtk/view.hpp"

#include "libcdem/vtk/labels.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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

View View::iso(const std::string& up, const std::vector<Vec3>& points,
               const std::vector<geom::Triangle>& surface) {
  constexpr double hardly = 1.05;  // times what the usual corner shows
  constexpr double upwards = 0.05; // of a unit normal along the upward axis
  const Vec3 vertical = up == "z" ? Vec3::UnitZ() : Vec3::UnitY();
  const View usual = named("iso", up);
  View best = usual;
  double most = 0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::AngleAxisd turn(quarter * M_PI / 2, vertical);
    const Vec3 toward = turn * usual.toward;
    double shown = 0; // m2, projected
    for (const geom::Triangle& t : surface) {
      const Vec3 area =
          0.5 * (points[static_cast<std::size_t>(t[1])] - points[static_cast<std::size_t>(t[0])])
                    .cross(points[static_cast<std::size_t>(t[2])] - points[static_cast<std::size_t>(t[0])]);
      if (area.dot(vertical) > upwards * area.norm())
        shown += std::max(0.0, area.dot(toward));
    }
    if (shown <= (quarter == 0 ? 0 : hardly * most))
      continue;
    most = shown;
    best.toward = toward;
    best.right = turn * usual.right;
    best.up = turn * usual.up;
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
