// Stereonets: poles of joints and great circles of planes, and the same as a table.
#include "lua/binding/functions/discs.hpp"
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/functions/radians_given.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/text/csv.hpp"

#include "libcdem/vtk/stereonet.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>

namespace cdem::script {

namespace {

using geom::InputError;

constexpr double same_plane = 1e-6; // of a plane's normal, and of its offset over the size of the blocks

geom::Orientation orientation(double dip, double dip_direction) { // deg
  return {radians(dip), radians(dip_direction)};
}

// Of each joint set or cut the planes that made faces of the blocks, each plane once.
std::map<std::string, std::vector<geom::Orientation>> planes_of_blocks(const geom::Assembly& assembly) {
  std::map<std::string, std::vector<geom::Orientation>> by_name;
  const double size = geom::bounding_box(assembly).size().norm();
  std::map<std::string, std::set<std::array<long, 4>>> known;
  for (const geom::Polyhedron& block : assembly.blocks)
    for (int f = 0; f < static_cast<int>(block.faces.size()); ++f) {
      const geom::PolyhedronFace& face = block.faces[f];
      if (face.cut.empty() || face.glued)
        continue;
      geom::Vec3 normal = geom::face_normal(block, f);
      if (normal.z() < 0 || (normal.z() < same_plane && normal.x() + 0.5 * normal.y() < 0))
        normal = -normal;
      const double offset = normal.dot(geom::face_centroid(block, f)) / size;
      std::array<long, 4> name{};
      for (int i = 0; i < 4; ++i)
        name[i] = std::lround((i < 3 ? normal[i] : offset) / same_plane / 4);
      if (known[face.cut].insert(name).second)
        by_name[face.cut].push_back(geom::orientation_of(normal));
    }
  return by_name;
}

std::vector<StereonetPoles> poles_of(Session& session, const Arguments& a) {
  std::vector<StereonetPoles> all;
  // Poles of one name are one set, however they are given.
  const auto add = [&](const StereonetPoles& poles) {
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const auto& set) { return set.name == poles.name; });
    if (known == all.end()) {
      all.push_back(poles);
      return;
    }
    known->planes.insert(known->planes.end(), poles.planes.begin(), poles.planes.end());
    if (poles.colour)
      known->colour = poles.colour;
  };
  std::size_t sets = 0;
  std::vector<double> dips, directions; // deg
  for (const Arguments& given : a.records("poles")) {
    StereonetPoles poles;
    poles.name = given.text("name");
    poles.colour = colour_of(given);
    const std::string set = fmt::format("poles[{}]", ++sets);
    for (const Value& row : given.list("planes")) {
      const double dip = row.table()->items[0].number(), direction = row.table()->items[1].number();
      const std::string place = fmt::format("{}.planes[{}]", set, poles.planes.size() + 1);
      if (!(dip >= 0 && dip <= 90))
        throw InputError(place, describe(row), "{dip, dip_direction} with a dip from 0 to 90 degrees");
      if (!(direction >= 0 && direction <= 360))
        throw InputError(place, describe(row), "{dip, dip_direction} with a direction from 0 to 360 degrees");
      poles.planes.push_back(orientation(dip, direction));
      dips.push_back(dip);
      directions.push_back(direction);
    }
    add(poles);
  }
  if (!dips.empty())
    warn_of_radians(session, "stereonet: planes of poles", dips, directions);
  std::map<std::string, std::vector<geom::Orientation>> by_name;
  for (const geom::Disc& disc : discs_of(session, a))
    by_name[disc.set].push_back({disc.dip, disc.dip_direction});
  if (const auto shape = a.object<AssemblyObject>("shape"))
    for (auto& [name, planes] : planes_of_blocks(shape->assembly))
      by_name[name].insert(by_name[name].end(), planes.begin(), planes.end());
  for (auto& [name, planes] : by_name)
    add({name, planes});
  return all;
}

std::vector<StereonetPlane> planes_of(Session& session, const Arguments& a) {
  std::vector<StereonetPlane> all;
  std::vector<double> dips, directions; // deg
  for (const Arguments& given : a.records("planes")) {
    StereonetPlane plane;
    plane.name = given.text("name");
    plane.plane = orientation(given.number("dip"), given.number("dip_direction"));
    plane.dashed = given.flag("dashed");
    plane.colour = colour_of(given);
    dips.push_back(given.number("dip"));
    directions.push_back(given.number("dip_direction"));
    all.push_back(std::move(plane));
  }
  if (!dips.empty())
    warn_of_radians(session, "stereonet: planes", dips, directions);
  return all;
}

std::string table_of(const std::vector<StereonetPoles>& poles, const std::vector<StereonetPlane>& planes) {
  std::string text = "kind,name,dip,dip_direction,x,y\n";
  const auto add = [&](const char* kind, const std::string& name, const geom::Orientation& o) {
    const Eigen::Vector2d x = (1e9 * geom::pole_on_net(o)).array().round() / 1e9 + 0.0; // no -0
    text += fmt::format("{},{},{:.6g},{:.6g},{:.9g},{:.9g}\n", kind, csv_cell(name), degrees(o.dip),
                        degrees(o.dip_direction), x.x(), x.y());
  };
  for (const StereonetPoles& set : poles)
    for (const geom::Orientation& o : set.planes)
      add("pole", set.name, o);
  for (const StereonetPlane& plane : planes)
    add("plane", plane.name, plane.plane);
  return text;
}

Value stereonet_of_planes(Session& session, Object*, const Arguments& a) {
  require_drawing(a.text("file"));
  const std::vector<StereonetPoles> poles = poles_of(session, a);
  const std::vector<StereonetPlane> planes = planes_of(session, a);
  if (poles.empty() && planes.empty())
    throw InputError(a.has("shape")
                         ? "shape: no joint set or cut made a face of these blocks; give poles, discs or "
                           "planes"
                         : "give poles, discs, shape or planes: something to draw");
  StereonetOptions options;
  options.title = a.text_or("title", "");
  options.size = size_of(a, false);
  options.dpi = a.number("dpi");
  if (session.settings.check_only)
    return {};
  draw(session, a.text("file"), [&](const std::string& path) { stereonet(poles, planes, options, path); });
  write_file(session.files.to_write(std::filesystem::path(a.text("file")).replace_extension(".csv").string()),
             table_of(poles, planes));
  return {};
}

} // namespace

void bind_stereonets(Module& m) {
  m.add("stereonet",
        "Stereonet (Schmidt net, equal-area, lower hemisphere, north up): poles of joints with their "
        "scatter, great circles of planes. A table of the same name that ends in .csv has kind, name, dip, "
        "dip_direction and the place x, y of each pole on a net of radius 1.",
        {drawing_field(),
         list("poles", record_type({text("name").required().doc("in the legend"),
                                    list("planes", tuple_type({number_type(), number_type()}))
                                        .required()
                                        .doc("{dip, dip_direction} (deg) of each"),
                                    colour_field()})),
         list("discs", record_type(disc_record().fields())).doc("joints of finite size; poles by set"),
         object("shape", "Assembly")
             .doc("blocks: poles of the planes that cut them, by joint set or name of the cut; glued cuts "
                  "are no joints"),
         list("planes", record_type({text("name").required().doc("in the legend"),
                                     number("dip", "deg").within(0, 90).required(),
                                     number("dip_direction", "deg").within(0, 360).required(),
                                     flag("dashed").standard(false), colour_field()}))
             .doc("great circles: slope faces, mean planes of sets"),
         text("title"), size_field(), dpi_field()},
        stereonet_of_planes)
      .replayed(Replay::recorded)
      .by_rank_0();
}

} // namespace cdem::script
