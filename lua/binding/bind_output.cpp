// Files of a model: ParaView, pictures, films.
#include "lua/binding/model_object.hpp"
#include "lua/binding/module.hpp"
#include "lua/binding/nearest.hpp"
#include "lua/binding/picture_fields.hpp"

#include "libcdem/vtk/film.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;
namespace fs = std::filesystem;

Value save(Session& session, ModelObject& model, const Arguments& a) {
  require_ending(a.text("file"), ".vtu");
  if (a.has("series"))
    require_ending(a.text("series"), ".pvd");
  if (session.settings.check_only)
    return {};
  const Snapshot snapshot = model.simulation.snapshot(model.title(session));
  const fs::path path = session.files.to_write(a.text("file"));
  write_vtu(snapshot, path.string());
  write_bonds(snapshot, session.files.to_write(bonds_path(a.text("file"))).string());
  if (a.has("series")) {
    const fs::path series = session.files.to_write(a.text("series"));
    auto& entries = model.series[series.string()];
    const std::string file = path.lexically_relative(series.parent_path()).generic_string();
    const auto same = [&](const SeriesEntry& e) { return e.file == file; };
    entries.erase(std::remove_if(entries.begin(), entries.end(), same), entries.end());
    // Relaxations have no time: the steps so far keep their moments in order.
    const double moment = snapshot.time > 0 ? snapshot.time : static_cast<double>(snapshot.step);
    entries.push_back({moment, file});
    write_pvd(series.string(), entries);
  }
  return {};
}

PictureOptions picture_options(const Arguments& a) {
  PictureOptions options;
  options.field = a.text_or("colour", "");
  options.deformation = a.number("deformation");
  options.view = a.text("view");
  options.up = a.text("up");
  if (const auto camera = a.record("camera")) {
    options.camera.emplace();
    options.camera->position = camera->vec3("position");
    options.camera->focal_point = camera->vec3("focal_point");
    options.camera->up = camera->vec3("up");
    options.camera->view_angle = camera->number("view_angle");
    options.camera->perspective = camera->flag("perspective");
  }
  options.size = size_of(a);
  options.range = limits_of(a, "range");
  options.colour_map = a.text("colour_map");
  options.title = a.text_or("title", "");
  options.edges = a.flag("edges");
  options.broken_bonds = a.flag("broken_bonds");
  options.colour_bar = a.flag("colour_bar");
  options.legend = a.flag("legend");
  options.axes = a.flag("axes");
  for (const Arguments& given : a.records("markers")) {
    Marker marker;
    marker.position = given.vec3("at");
    marker.label = given.text_or("label", "");
    marker.colour = colour_of(given).value_or(marker.colour);
    marker.size = given.number("size");
    options.markers.push_back(marker);
  }
  for (const Arguments& given : a.records("lines")) {
    Polyline line;
    for (const Value& point : given.list("points"))
      line.points.push_back(to_vec3(point));
    line.label = given.text_or("label", "");
    line.colour = colour_of(given).value_or(line.colour);
    line.width = given.number("width");
    line.dashed = given.flag("dashed");
    options.polylines.push_back(line);
  }
  return options;
}

Value picture(Session& session, ModelObject& model, const Arguments& a) {
  require_ending(a.text("file"), ".png");
  const PictureOptions options = picture_options(a);
  if (session.settings.check_only) {
    const auto names = picture_fields(model.simulation.snapshot(""));
    if (!options.field.empty() && std::find(names.begin(), names.end(), options.field) == names.end())
      throw InputError("colour = \"" + options.field + "\": no such field" +
                       did_you_mean(options.field, names) + " There are: " + joined(names));
    return {};
  }
  render(model.simulation.snapshot(model.title(session)), options,
         session.files.to_write(a.text("file")).string());
  return {};
}

Value film(Session& session, Object*, const Arguments& a) {
  require_ending(a.text("file"), ".ogv");
  if (session.settings.check_only)
    return {};
  std::vector<std::string> frames;
  for (const Value& frame : a.list("frames"))
    frames.push_back(session.files.to_read(*frame.get<std::string>()).string());
  write_film(frames, static_cast<int>(a.integer("frames_per_second")),
             session.files.to_write(a.text("file")).string());
  return {};
}

std::vector<Field> picture_declaration() {
  const std::vector<Field> camera{
      vec3("position").unit("m").required(), vec3("focal_point").unit("m").required(),
      vec3("up").standard(Value(geom::Vec3(0, 1, 0))),
      number("view_angle").between(0, 180).unit("deg").standard(30.0).doc("over the height of the picture"),
      flag("perspective").standard(true)};
  const std::vector<Field> marker{vec3("at").unit("m").required().doc("undeformed place"), text("label"),
                                  colour_field(),
                                  number("size").above(0).standard(14.0).doc("pixels across")};
  const std::vector<Field> line{list("points", vec3_type(), 2).unit("m").required(), text("label"),
                                colour_field(), number("width").above(0).standard(4.0).doc("pixels"),
                                flag("dashed").standard(false)};
  return {text("file").required().doc("ends in .png; in the output folder"),
          text("colour").doc(
              "field to colour by, e.g. \"displacement.x\", \"stress.yy\", \"von_mises\", \"block_id\"; "
              "plain blocks when left out"),
          number("deformation")
              .standard(0.0)
              .doc("displacements are drawn this many times larger; 0: undeformed"),
          choice("view", {"front", "back", "left", "right", "top", "bottom", "iso"})
              .standard("front")
              .doc("front looks along -z at the x-y plane"),
          choice("up", {"y", "z"}).standard("y").doc("z: front looks along y with z up"),
          record("camera", camera).doc("instead of view"),
          size_field(),
          list("range", number_type(), 2).doc("{lowest, highest} of the colours, SI units"),
          choice("colour_map", {"auto", "blue_white_red", "cool_warm", "viridis", "grey", "categorical"})
              .standard("auto")
              .doc("auto: blue_white_red when values change sign, viridis when not"),
          text("title").doc("_{...} and ^{...} set sub- and superscripts"),
          flag("edges").standard(true).doc("outlines of the blocks"),
          flag("broken_bonds").standard(true).doc("broken interfaces, coloured by how they broke"),
          flag("colour_bar").standard(true),
          flag("legend").standard(true),
          flag("axes").standard(true).doc("small arrows that name the directions"),
          list("markers", record_type(marker), 0),
          list("lines", record_type(line), 0)};
}

} // namespace

void bind_output(Module& m) {
  Class& model = m.the_class("Model");
  model.methods.push_back(
      {"save",
       "Writes the model for ParaView: blocks to the file, bonds beside it (result.vtu, result_bonds.vtu).",
       {text("file").required().doc("ends in .vtu; in the output folder"),
        text("series").doc("ends in .pvd: a time series this file is added to")},
       false,
       "",
       "",
       method<ModelObject>(save)});
  model.methods.push_back({"picture", "Draws the model, without a display.", picture_declaration(), false, "",
                           "", method<ModelObject>(picture)});
  m.functions.push_back({"film",
                         "A film (Ogg/Theora) from pictures of one size.",
                         {text("file").required().doc("ends in .ogv; in the output folder"),
                          list("frames", text_type()).required().doc("names of the pictures, in order"),
                          integer("frames_per_second").within(1, 120).standard(12)},
                         false,
                         "",
                         "",
                         film});
}

} // namespace cdem::script
