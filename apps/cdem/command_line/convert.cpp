#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/commands/commands.hpp"
#include "apps/cdem/process/failure.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedConvert {
  std::string from, to;
};

} // namespace

Command convert_command() {
  const auto typed = std::make_shared<TypedConvert>();
  Command command("convert", "make a mesh of another program one that cdem reads");
  command.argument("FROM", typed->from,
                   "a mesh that meshio reads: .bdf, .cgns, .e, .mesh, .med, .xdmf, .vtk, .ply, ...");
  command.argument("TO", typed->to, "the .vtu (tetrahedra) or .stl (triangles) to write");
  command.examples = "  cdem convert model.bdf model.vtu\n  cdem convert drum.ply drum.stl\n";
  command.action = [typed, name = command.name](const TypedLine&) -> Action {
    refuse_ranks(name);
    require_file(typed->from, name, "FROM TO");
    if (typed->to.empty())
      throw UsageError("cdem convert FROM TO: the file to write is missing, a .vtu or .stl");
    return [from = typed->from, to = typed->to] { return convert(from, to); };
  };
  return command;
}

} // namespace cdem::app
