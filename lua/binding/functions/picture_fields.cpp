#include "lua/binding/functions/picture_fields.hpp"

#include "libcdem/vtk/picture_room.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/session.hpp"

#include <cmath>

namespace cdem::script {

using geom::InputError;

Field size_field() {
  return list("size", number_type(), 2)
      .standard(Value(Table::list({1600, 1200})))
      .doc("{width, height} in pixels; height 0: as high as it needs to be");
}

Field dpi_field() {
  return number("dpi").within(10, 2400).standard(300.0).doc(
      "pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300");
}

Field drawing_field() {
  return text("file").required().doc("ends in .png, .svg or .pdf").output();
}

Field colour_field() {
  return list("colour", number_type(), 3).doc("{red, green, blue}, each 0 .. 1");
}

std::array<int, 2> size_of(const Arguments& a, bool free_height) {
  const auto size = a.numbers("size");
  const auto side = [](double x) {
    return x == std::floor(x) && x >= least_picture_side && x <= most_picture_side;
  };
  if (size.size() != 2 || !side(size[0]) || !(side(size[1]) || (free_height && size[1] == 0)))
    throw InputError("size", describe(a.value("size")),
                     "{width, height} in pixels, each " + std::to_string(least_picture_side) + " to " +
                         std::to_string(most_picture_side) +
                         (free_height ? "; height 0: as high as needed" : ""));
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

std::optional<Colour> colour_of(const Arguments& a) {
  if (!a.has("colour"))
    return std::nullopt;
  const auto c = a.numbers("colour");
  if (c.size() != 3)
    throw InputError("colour", describe(a.value("colour")), "{red, green, blue}");
  for (const double x : c)
    if (x < 0 || x > 1)
      throw InputError("colour", describe(a.value("colour")), "numbers from 0 to 1");
  return Colour{c[0], c[1], c[2]};
}

std::optional<std::array<double, 2>> limits_of(const Arguments& a, const std::string& name) {
  if (!a.has(name))
    return std::nullopt;
  const auto limits = a.numbers(name);
  if (limits.size() != 2 || !(limits[0] < limits[1]))
    throw InputError(name, describe(a.value(name)), "{lowest, highest}");
  return std::array<double, 2>{limits[0], limits[1]};
}

namespace {

const Record<Camera> camera_record{
    {{vec3("position", "m").required(), &Camera::position},
     {vec3("focal_point", "m").required(), &Camera::focal_point},
     {vec3("up").standard(), &Camera::up},
     {number("view_angle", "deg").between(0, 180).standard().doc("over the height of the picture"),
      &Camera::view_angle},
     {flag("perspective").standard(), &Camera::perspective}}};

const Record<Marker> marker_record{
    {{vec3("at", "m").required().doc("undeformed place"), &Marker::position},
     {text("label"), &Marker::label},
     {colour_field()},
     {number("size").above(0).standard().doc("pixels across"), &Marker::size}}};

const Record<Polyline> line_record{{{list("points", vec3_type(), 2).unit("m").required(), &Polyline::points},
                                    {text("label"), &Polyline::label},
                                    {colour_field()},
                                    {number("width").above(0).standard().doc("pixels"), &Polyline::width},
                                    {flag("dashed").standard(), &Polyline::dashed}}};

const Record<PictureOptions> view_record{
    {{drawing_field()},
     {text("colour"), &PictureOptions::field},
     {choice("view", {"front", "back", "left", "right", "top", "bottom", "iso"})
          .standard("front")
          .doc("front looks along -z at the x-y plane"),
      &PictureOptions::view},
     {choice("up", {"y", "z"}), &PictureOptions::up},
     {record("camera", camera_record.fields()).doc("instead of view"), &PictureOptions::camera,
      camera_record},
     {box("fit").doc("a box that the view shows, in place of what is drawn: give it to all frames of a film, "
                     "so that the camera does not move with what falls"),
      &PictureOptions::fit},
     {size_field()},
     {dpi_field(), &PictureOptions::dpi},
     {list("range", number_type(), 2).doc("{lowest, highest} of the colours, SI units")},
     {choice("colour_map", {"auto", "blue_white_red", "cool_warm", "viridis", "grey", "categorical"})
          .standard("auto")
          .doc("auto: blue_white_red when values change sign, viridis when not. Without a range the colours "
               "span all values but a few outliers; the legend tells them"),
      &PictureOptions::colour_map},
     {text("title").doc("_{...} and ^{...} set sub- and superscripts"), &PictureOptions::title},
     {flag("colour_bar").standard(), &PictureOptions::colour_bar},
     {flag("legend").standard(), &PictureOptions::legend},
     {flag("axes").standard().doc("small arrows that name the directions"), &PictureOptions::axes},
     {flag("scale_bar").standard().doc("a round length under the body; none in perspective"),
      &PictureOptions::scale_bar},
     {vec3("north").doc("the direction of north, {0, 1, 0}: an arrow N beside those of the axes"),
      &PictureOptions::north},
     {list("markers", record_type(marker_record.fields()), 0)},
     {list("lines", record_type(line_record.fields()), 0)}}};

} // namespace

std::vector<Field> view_fields(const std::string& colour_doc, const std::string& usual_up) {
  std::vector<Field> fields = view_record.fields();
  for (Field& field : fields)
    if (field.name == "colour")
      field.doc(colour_doc);
    else if (field.name == "up")
      field.doc("z: front looks along y with z up; default: " + usual_up);
  return fields;
}

PictureOptions view_options(const Arguments& a) {
  PictureOptions options = view_record.read(a);
  options.size = size_of(a);
  options.range = limits_of(a, "range");
  for (const Arguments& given : a.records("markers")) {
    Marker marker = marker_record.read(given);
    marker.colour = colour_of(given).value_or(marker.colour);
    options.markers.push_back(marker);
  }
  for (const Arguments& given : a.records("lines")) {
    Polyline line = line_record.read(given);
    line.colour = colour_of(given).value_or(line.colour);
    options.polylines.push_back(line);
  }
  return options;
}

void draw(Session& session, const std::string& file,
          const std::function<void(const std::string& path)>& body) {
  const std::string path = session.files.to_write(file).string();
  try {
    body(path);
  } catch (const NoRoomForPicture& error) {
    session.warn(file + " is not drawn: " + geom::plain_reason(error));
  }
}

void require_drawing(const std::string& file) {
  require_one_of(file, {".png", ".svg", ".pdf"});
}

void require_one_of(const std::string& file, const std::vector<std::string>& endings) {
  std::string all;
  for (const std::string& ending : endings) {
    if (file.size() > ending.size() && file.compare(file.size() - ending.size(), ending.size(), ending) == 0)
      return;
    all += (all.empty() ? "" : &ending == &endings.back() ? " or " : ", ") + ending;
  }
  throw InputError("file", "\"" + file + "\"", "a name that ends in " + all);
}

void require_ending(const std::string& file, const std::string& ending) {
  require_one_of(file, {ending});
}

} // namespace cdem::script
