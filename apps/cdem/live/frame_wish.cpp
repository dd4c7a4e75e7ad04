#include "apps/cdem/live/frame_wish.hpp"

#include "apps/cdem/results/usual_field.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/outline.hpp"
#include "libcdem/vtk/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace cdem::app {
namespace {

using geom::Vec3;

constexpr std::size_t longest_word = 200;
constexpr double largest_number = 1e12, least_zoom = 0.05, most_zoom = 100, farthest_shift = 100;
constexpr std::array<int, 2> frame_size{1200, 900}; // pixels
constexpr double body_aspect = 1.25;                // of the frame without its colour bar, at least
constexpr double room = 1.06;                       // of the frame over that of the box

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(std::abs(value) <= largest_number))
    return std::nullopt;
  return value;
}

std::optional<double> number(const std::string& text, double least, double most) {
  const auto value = number(text);
  return value && *value >= least && *value <= most ? value : std::nullopt;
}

std::optional<int> index(const std::string& text, int count) {
  const auto value = number(text, 0, count - 1);
  return value && *value == std::floor(*value) ? std::optional<int>(static_cast<int>(*value)) : std::nullopt;
}

bool is_one_of(const std::vector<std::string>& all, const std::string& word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

template <class T, class U>
bool set(T& into, const std::optional<U>& value) {
  if (value)
    into = *value;
  return value.has_value();
}

View view_of(const FrameWish& wish, const Snapshot& snapshot) {
  View view = wish.view == "iso" ? View::iso(wish.up, snapshot.points, snapshot.surface)
                                 : View::named(wish.view, wish.up);
  const Vec3 vertical = wish.up == "z" ? Vec3::UnitZ() : Vec3::UnitY();
  const Eigen::AngleAxisd turn(wish.turn * M_PI / 180, vertical);
  const Eigen::AngleAxisd tilt(-wish.tilt * M_PI / 180, turn * view.right);
  view.right = turn * view.right;
  view.up = tilt * (turn * view.up);
  view.toward = tilt * (turn * view.toward);
  return view;
}

} // namespace

bool FrameWish::take(const std::map<std::string, std::string>& words, const std::vector<std::string>& fields,
                     const std::vector<ShownFile>& files) {
  static const std::vector<std::string> views{"front", "back", "left", "right", "top", "bottom", "iso"};
  FrameWish next = *this;
  std::map<std::string, std::string> ends; // of the range
  for (const auto& [name, value] : words) {
    bool good = value.size() <= longest_word;
    if (!good)
      return false;
    if (name == "colour")
      good = value.empty() || is_one_of(fields, value), next.colour = value;
    else if (name == "view")
      good = is_one_of(views, value), next.view = value;
    else if (name == "up")
      good = value == "y" || value == "z", next.up = value;
    else if (name == "deformation")
      good = set(next.deformation, number(value));
    else if (name == "turn")
      good = set(next.turn, number(value));
    else if (name == "tilt")
      good = set(next.tilt, number(value));
    else if (name == "zoom")
      good = set(next.zoom, number(value, least_zoom, most_zoom));
    else if (name == "right")
      good = set(next.shift[0], number(value, -farthest_shift, farthest_shift));
    else if (name == "upwards")
      good = set(next.shift[1], number(value, -farthest_shift, farthest_shift));
    else if (name == "low" || name == "high")
      ends[name] = value;
    else if (name == "file" && !files.empty())
      good = set(next.file, index(value, static_cast<int>(files.size())));
    else if (name != "step" || files.empty())
      good = false;
    if (!good)
      return false;
  }
  if (const auto asked = words.find("step"); asked != words.end()) {
    if (!set(next.step, index(asked->second, files[static_cast<std::size_t>(next.file)].steps)))
      return false;
  } else if (next.file != file) {
    next.step = 0;
  }
  if (!ends.empty()) {
    const auto low = number(ends["low"]), high = number(ends["high"]);
    const bool none = ends["low"].empty() && ends["high"].empty();
    if (!none && !(low && high && *low < *high))
      return false;
    next.range = none ? std::nullopt : std::optional(std::array<double, 2>{*low, *high});
  }
  *this = next;
  return true;
}

void choose_view(const Snapshot& snapshot, FrameWish& wish) {
  const Vec3 size = shown_box(snapshot, 0).size();
  const bool plate = size.z() < 0.25 * std::min(size.x(), size.y());
  if (wish.view.empty())
    wish.view = plate ? "front" : "iso";
  if (wish.up.empty())
    wish.up = plate ? "y" : "z";
}

PictureOptions frame_options(const FrameWish& wish, const Snapshot& snapshot, const geom::Box& box) {
  PictureOptions options;
  options.size = frame_size;
  const std::vector<std::string> fields = picture_fields(snapshot);
  options.field = wish.colour.empty() || is_one_of(fields, wish.colour) ? wish.colour : usual_field(snapshot);
  options.range = wish.range;
  if (displacement_of(snapshot.point_fields))
    options.deformation = wish.deformation;
  const View view = view_of(wish, snapshot);
  geom::Box extent;
  for (int corner = 0; corner < 8; ++corner)
    extent.extend(
        view.in_view({corner & 1 ? box.max.x() : box.min.x(), corner & 2 ? box.max.y() : box.min.y(),
                      corner & 4 ? box.max.z() : box.min.z()}));
  const Vec3 size = extent.size();
  const double height = room * std::max({size.y(), size.x() / body_aspect, 1e-9 * size.norm()}) / wish.zoom;
  const double distance = // outside the model; the view angle of a camera must be more than 0.1 degrees
      std::min(3 * size.norm(), height / (2 * std::tan(0.06 * M_PI / 180)));
  Camera camera;
  camera.focal_point = box.centre() - height * (wish.shift[0] * view.right + wish.shift[1] * view.up);
  camera.position = camera.focal_point + distance * view.toward;
  camera.up = view.up;
  camera.view_angle = 360 / M_PI * std::atan(height / (2 * distance));
  camera.perspective = false;
  options.camera = camera;
  return options;
}

geom::Box shown_box(const Snapshot& snapshot, double deformation) {
  geom::Box box;
  for (const Vec3& x : deformed(snapshot.points, displacement_of(snapshot.point_fields), deformation))
    box.extend(x);
  return box;
}

} // namespace cdem::app
