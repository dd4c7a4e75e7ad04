// cdem render: a picture of a .vtu file.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/results/usual_field.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libcdem/vtk/without_bodies.hpp"
#include "libgeom/core/error.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <set>
#include <unistd.h>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

// Numbers in cell field "body" that there are, ascending, with their names where the file tells them.
std::map<int, std::string> bodies_of(const Snapshot& snapshot) {
  std::map<int, std::string> bodies;
  if (const SnapshotField* field = find_field(snapshot.cell_fields, "body"))
    for (const double value : field->values) {
      const auto number = static_cast<std::size_t>(value);
      bodies.emplace(static_cast<int>(value),
                     number < snapshot.body_names.size() ? snapshot.body_names[number] : "");
    }
  return bodies;
}

// A name goes before a number that reads the same.
int body_number(const std::map<int, std::string>& bodies, const std::string& asked) {
  for (const auto& [number, name] : bodies)
    if (!name.empty() && name == asked)
      return number;
  for (const auto& [number, name] : bodies)
    if (std::to_string(number) == asked)
      return number;
  std::string known;
  for (const auto& [number, name] : bodies)
    known += (known.empty() ? "" : ", ") + std::to_string(number) + (name.empty() ? "" : " " + name);
  throw geom::InputError("--hidden", asked,
                         bodies.empty() ? "left out: the file does not tell bodies"
                                        : "a body of the file, by name or number: " + known);
}

Snapshot without(const Snapshot& snapshot, const std::vector<std::string>& hidden) {
  if (hidden.empty())
    return snapshot;
  const std::map<int, std::string> bodies = bodies_of(snapshot);
  std::vector<int> numbers;
  numbers.reserve(hidden.size());
  for (const std::string& body : hidden)
    numbers.push_back(body_number(bodies, body));
  if (std::set<int>(numbers.begin(), numbers.end()).size() == bodies.size())
    throw geom::InputError("--hidden", "every body", "fewer: nothing would be left to draw");
  return without_bodies(snapshot, numbers);
}

} // namespace

ExitCode render_picture(const RenderCommand& command) {
  if (!is_there(command.file))
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
  std::error_code none;
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
  options.dpi = command.dpi;
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
