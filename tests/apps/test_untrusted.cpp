// A folder from a stranger: whatever lies in it beside the named file, nothing of it is read or run.
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const char* const one_tet = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                            "4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";

} // namespace

TEST_CASE("gmsh runs no command from a folder or a home: in run, check and info, meshes and STEP") {
  const TempFolder folder;
  const std::string trace = (folder / "trace").string(), command = "SystemCall \"touch " + trace + "\";\n";
  write_file(folder / "job/make.lua",
             "require('cdem').solid.box{ size = {1, 1, 1} }:save{ file = 'part.step' }");
  Start start;
  start.folder = folder / "job";
  REQUIRE(run_cdem({"run", "make.lua", "--output", "made"}, start).exit_code == 0);
  fs::copy_file(folder / "job/made/part.step", folder / "job/part.step");
  write_file(folder / "job/part.msh", one_tet);
  write_file(folder / "job/case.lua", "local cdem = require 'cdem'\n"
                                      "print(cdem.read_mesh{ file = 'part.msh' }, \n"
                                      "  cdem.solid.read{ file = 'part.step' }:mesh{ size = 0.5 })");
  for (const std::string name : {"part.msh.opt", "part.step.opt", "part.opt", "part.geo", "part.geo.opt",
                                 "untitled.geo", "untitled.geo.opt", "gmsh.opt", ".gmshrc", ".gmsh-options",
                                 "out/part.msh.opt", "../home/.gmshrc", "../home/.gmsh-options"})
    write_file(folder / "job" / name, command);
  fs::remove_all(folder / "job/out");
  start.environment = {"HOME=" + (folder / "home").string(), "GMSH_HOME=" + (folder / "home").string(),
                       "GMSHPLUGINSHOME=" + (folder / "home").string()};
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "case.lua", "--output", "out"},
        {"check", "case.lua"},
        {"info", "case.lua"}}) {
    INFO(arguments[0]);
    const Outcome outcome = run_cdem(arguments, start);
    CHECK(outcome.err == "");
    CHECK(outcome.exit_code == 0);
    CHECK_FALSE(fs::exists(trace));
  }
}

TEST_CASE("a script of gmsh's is not read, whatever it is called") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  for (const std::string name :
       {"a.geo", "a.msh", "a.mesh", "a.vtk", "a.pos", "a.opt", "a.step", "a.stl", "a.py"}) {
    INFO(name);
    write_file(folder / name, "SystemCall \"touch " + (folder / "trace").string() + "\";\n");
    for (const std::string function : {"read_mesh", "solid.read"}) {
      write_file(folder / "case.lua", "require('cdem')." + function + "{ file = '" + name + "' }");
      const Outcome outcome = run_cdem({"check", "case.lua"}, start);
      CHECK(outcome.exit_code == 2);
      CHECK_THAT(outcome.err, Contains("cdem: error: case.lua:1: cdem." + function + ": "));
      CHECK(lines_of(outcome.err).size() == 1);
    }
  }
  CHECK_FALSE(fs::exists(folder / "trace"));
}

TEST_CASE("two scripts that sweep each other end, in run and check") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  for (const std::string name : {"a", "b"})
    write_file(folder / (name + ".lua"),
               "local cdem = require 'cdem'\n"
               "cdem.parameter{ name = 'x', default = 0 }\n"
               "cdem.sweep{ script = '" +
                   std::string(name == "a" ? "b" : "a") +
                   ".lua', set = { { x = 1 }, { x = 2 } }, jobs = 2 }\nprint 'end'");
  for (const std::string command : {"run", "check"}) {
    INFO(command);
    const Outcome outcome = run_cdem({command, "a.lua"}, start);
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("end"));
  }
  std::string innermost;
  std::size_t runs = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    if (entry.path().filename() == "cdem.log") {
      ++runs;
      innermost += read_file(entry.path());
    }
  CHECK(runs == 1 + 2 + 4); // a run that was refused at once leaves no folder
  CHECK_THAT(innermost, Contains("3 sweeps stand within each other already"));
}
