// cdem render: a picture of a .vtu file.
#include "apps/cdem/commands/commands.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libcdem/vtk/without_bodies.hpp"
#include "libgeom/core/error.hpp"
#include "lua/binding/engine.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>
#include <unistd.h>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

// What to colour by when the user does not say: a file of a mesh has no displacement.
std::string usual_field(const Snapshot& snapshot) {
  if (displacement_of(snapshot.point_fields))
    return "displacement.magnitude";
  if (find_field(snapshot.cell_fields, "region"))
    return "region";
  for (const SnapshotField& field : snapshot.cell_fields)
    if (field.components == 1)
      return field.name;
  return "";
}

Snapshot without(const Snapshot& snapshot, const std::vector<int>& hidden) {
  if (hidden.empty())
    return snapshot;
  std::set<int> bodies;
  if (const SnapshotField* field = find_field(snapshot.cell_fields, "body"))
    for (const double number : field->values)
      bodies.insert(static_cast<int>(number));
  std::string known;
  for (const int body : bodies)
    known += (known.empty() ? "" : ", ") + std::to_string(body);
  for (const int body : hidden)
    if (bodies.count(body) == 0)
      throw geom::InputError("--hidden", std::to_string(body),
                             bodies.empty() ? "left out: the file does not tell bodies"
                                            : "a body of the file: " + known);
  for (const int body : hidden)
    bodies.erase(body);
  if (bodies.empty())
    throw geom::InputError("--hidden", known, "fewer bodies: nothing would be left to draw");
  return without_bodies(snapshot, hidden);
}

} // namespace

ExitCode render_picture(const RenderCommand& command) {
  std::error_code none;
  if (!fs::exists(command.file, none))
    throw script::FileError(command.file.string() + ": no such file");
  const Snapshot snapshot = read_vtu(command.file.string());
  const std::string colour = command.colour ? *command.colour : usual_field(snapshot);
  fs::path output = command.output;
  if (output.empty()) {
    output = command.file;
    output.replace_extension();
    output += (colour.empty() ? std::string() : "-" + colour) + ".png";
  }
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, none))
    throw script::FileError(output.string() + " cannot be written: there is no folder " + folder.string());
  if (access(folder.c_str(), W_OK) != 0)
    throw script::FileError(output.string() + " cannot be written: " + std::strerror(errno));
  PictureOptions options;
  options.field = colour;
  options.deformation = command.deformation;
  options.view = command.view;
  options.up = command.up;
  options.size = command.size;
  options.range = command.range;
  options.colour_map = command.colour_map;
  options.title = command.title;
  options.edges = command.edges;
  options.broken_bonds = command.broken_bonds;
  options.colour_bar = command.colour_bar;
  options.legend = command.legend;
  options.axes = command.axes;
  render(without(snapshot, command.hidden), options, output.string());
  std::printf("%s\n", output.c_str());
  return ExitCode::success;
}

} // namespace cdem::app
