// Solids and tetrahedral meshes in scripts: what goes in is what comes out.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string solids_head =
    opening + "local cube = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }\n";

} // namespace

TEST_CASE("a unit by mass and density has that volume, whatever its shape", "[lua]") {
  CHECK(error_of(solids_head + "for _, make in ipairs{ cdem.accropode, cdem.dolos, cdem.tetrapod, cdem.cube, "
                               "cdem.antifer, cdem.cubipod } do\n"
                               "  local unit = make{ mass = 5000, density = 2500 }\n"
                               "  close(unit:volume(), 2, 1e-8)\n  assert(unit.density == 2500)\n"
                               "  close(unit:inertia{}.mass, 5000, 1e-8)\n"
                               "  close(make{ height = unit.height }:volume(), 2, 1e-8)\nend") == "");
}

TEST_CASE("proportions left out are the shape's, those given replace them", "[lua]") {
  CHECK(error_of(solids_head +
                 "local function width(more)\n  more.height = 1\n"
                 "  local box = cdem.accropode(more):box()\n  return box.max[1] - box.min[1]\nend\n"
                 "close(width{}, 1, 1e-5)\nclose(width{ shape = 'stocky' }, 0.8, 1e-5)\n"
                 "close(width{ shape = 'stocky', length = 0.9 }, 0.9, 1e-5)") == "");
}

TEST_CASE("a unit's size is given once, in full and above zero", "[lua]") {
  CHECK_THAT(error_of(solids_head + "cdem.dolos{}"),
             Contains("height: missing; give the height, or mass and density"));
  CHECK_THAT(error_of(solids_head + "cdem.dolos{ density = 2500 }"),
             Contains("mass: missing; give the height, or mass and density"));
  CHECK_THAT(error_of(solids_head + "cdem.dolos{ height = 2, mass = 5000, density = 2500 }"),
             Contains("height and mass: both given"));
  CHECK_THAT(error_of(solids_head + "cdem.dolos{ height = -2 }"), Contains("height = -2: must be > 0"));
  CHECK_THAT(error_of(solids_head + "cdem.accropode{ height = 1, shape = 'stumpy' }"),
             Contains("shape = \"stumpy\": must be one of \"slender\", \"stocky\""));
  CHECK_THAT(error_of(solids_head + "cdem.tetrapod{ height = 1, root = 0.2 }"),
             Contains("root = 0.2: must be from 0.302 to 0.7"));
}

TEST_CASE("boolean operations share out the volume", "[lua]") {
  CHECK(error_of(solids_head +
                 "local a = cdem.solid.box{ size = {1, 2, 3} }\n"
                 "local b = cdem.solid.box{ size = {1, 2, 3}, origin = {0.5, 0, 0} }\n"
                 "close(cdem.solid.union{ solids = {a, b} }:volume(), 9)\n"
                 "close(cdem.solid.common{ solid = a, other = b }:volume(), 3)\n"
                 "close(cdem.solid.cut{ solid = a, tools = {b} }:volume(), 3)\n"
                 "local pieces = cdem.solid.fragments{ solids = {a, b} }\n"
                 "assert(#pieces == 3)\nfor _, v in ipairs(pieces:regions()) do close(v, 3) end\n"
                 "close(a:translate{ shift = {1, 0, 0} }:box().max[1], 2, 1e-5)\n"
                 "close(a:rotate{ axis = {0, 0, 1}, angle = 90 }:box().max[2], 1, 1e-5)\n"
                 "close(a:scale{ factor = 2 }:volume(), 48)\n"
                 "close(cdem.solid.cylinder{ radius = 1, axis = {0, 0, 2} }:volume(), 2 * math.pi)\n"
                 "close(cdem.solid.cone{ radius = 1, axis = {0, 0, 3} }:volume(), math.pi)\n"
                 "close(cdem.solid.sphere{ radius = 1 }:volume(), 4 * math.pi / 3)") == "");
}

TEST_CASE("a solid survives a STEP file, a mesh a .vtu with its regions", "[lua]") {
  Script script(solids_head +
                "local unit = cdem.accropode{ height = 1.5 }\nunit:save{ file = 'unit.step' }\n"
                "close(cdem.solid.read{ file = 'unit.step' }:volume(), unit:volume(), 1e-8)\n"
                "close(cdem.solid.read{ file = 'unit.step', scale = 2 }:volume(), 8 * unit:volume(), "
                "1e-8)\n"
                "local mesh = unit:mesh{ size = 0.3 }\nmesh:save{ file = 'unit.vtu' }\n"
                "local again = cdem.read_mesh{ file = 'unit.vtu' }\n"
                "assert(again.tets == mesh.tets and again.nodes == mesh.nodes)\n"
                "close(again:volume(), mesh:volume(), 1e-12)");
  CHECK(script.error() == "");
  CHECK(script.wrote("unit.step"));
}

TEST_CASE("an STL in millimetres becomes a solid in metres", "[lua]") {
  Script script(solids_head +
                "close(cdem.solid.read{ file = 'tet.STL', scale = 0.001 }:volume(), 1 / 6, 1e-6)");
  std::string stl = "solid tet\n";
  const double corners[4][3] = {{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {0, 0, 1000}};
  for (const auto& face : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) {
      stl += "vertex";
      for (const double x : corners[corner])
        stl += " " + std::to_string(x);
      stl += "\n";
    }
    stl += "endloop\nendfacet\n";
  }
  script.write("tet.STL", stl + "endsolid tet\n");
  CHECK(script.error() == "");
}

TEST_CASE("a mesh's inertia is that of what it fills, with the ratio of its principal moments", "[lua]") {
  CHECK(error_of(solids_head +
                 "local box = cdem.solid.box{ size = {1, 2, 3}, origin = {5, 0, 0} }\n"
                 "for _, i in ipairs{ box:inertia{ density = 10 }, box:mesh{ size = 1 }:inertia{ density = "
                 "10 } } do\n"
                 "  close(i.mass, 60)\n  close(i.centroid[1], 5.5)\n"
                 "  close(i.tensor[1][1], 65)\n  close(i.tensor[2][2], 50)\n  close(i.tensor[3][3], 25)\n"
                 "  close(i.principal[1], 25)\n  close(i.principal[3], 65)\n  close(i.principal_ratio, 65 / "
                 "25)\nend") == "");
}

TEST_CASE("the quality of a mesh counts and measures its tets", "[lua]") {
  CHECK(error_of(solids_head +
                 "local q = cube:quality()\n"
                 "assert(q.tets == 48 and q.nodes == 27 and q.outer_faces == 48)\n"
                 "close(q.volume, 1)\nclose(q.min_volume, 1 / 48)\nclose(q.max_volume, 1 / 48)\n"
                 "close(q.max_dihedral, 90)\nclose(q.min_dihedral, 45)\n" // of Kuhn's tets
                 "close(q.min_edge, 0.5)\nclose(q.max_edge, math.sqrt(3) / 2)\n"
                 "close(q.mean_radius_ratio, q.min_radius_ratio)") == "");
}

TEST_CASE("outer faces are found by side, by plane and by direction", "[lua]") {
  CHECK(error_of(solids_head +
                 "for _, place in ipairs{ { side = 'z+', name = 'top' }, { direction = {0, 0, 2} },\n"
                 "    { plane = { point = {9, 9, 1}, normal = {0, 0, -3} } } } do\n"
                 "  local group = cube:faces(place)\n"
                 "  assert(group.count == 8)\n  close(group.area, 1)\n  close(group.centroid[3], 1)\n"
                 "  close(group.area_vector[3], 1)\n  close(group.area_vector[1], 0)\nend\n"
                 "assert(cube:faces{ direction = {1, 1, 1}, angle = 60 }.count == 24)") == "");
  CHECK_THAT(error_of(solids_head + "cube:faces{ side = 'z+', direction = {0, 0, 1} }"),
             Contains("must have one of side, plane and direction"));
  CHECK_THAT(error_of(solids_head + "cube:faces{ direction = {0, 0, 0} }"), Contains("longer than zero"));
  CHECK_THAT(error_of(solids_head + "cube:faces{ plane = { point = {0, 0, 0}, normal = {0, 0, 0} } }"),
             Contains("plane.normal = {0, 0, 0}: must be longer than zero"));
}

TEST_CASE("tets are smaller where a script asks for it", "[lua]") {
  CHECK(
      error_of(
          solids_head +
          "local box = cdem.solid.box{ size = {1, 1, 1} }\n"
          "local plain = box:mesh{ size = 0.3 }\n"
          "for _, place in ipairs{ { at = {0, 0, 0} }, { line = { {0, 0, 0}, {1, 0, 0} } },\n"
          "    { box = { min = {0, 0, 0}, max = {0.2, 0.2, 0.2} } } } do\n"
          "  place.size = 0.06\n  local mesh = box:mesh{ size = 0.3, refine = { place } }\n"
          "  assert(mesh.tets > plain.tets)\n"
          "  assert(mesh:quality().min_edge < 1.2 * 0.06 and plain:quality().min_edge > 1.2 * 0.06)\nend") ==
      "");
  CHECK_THAT(error_of(solids_head + "cdem.cube{ height = 1 }:mesh{}"), Contains("size: missing"));
  CHECK_THAT(
      error_of(solids_head + "cdem.cube{ height = 1 }:mesh{ size = 0.5, refine = { { size = 0.1 } } }"),
      Contains("refine[1]: must have one of at, line and box"));
}

TEST_CASE("a solid that cannot be meshed is an error that a script can go on after", "[lua]") {
  Script script(solids_head +
                "local cube = cdem.cube{ height = 1 }\nlocal before = cube:mesh{ size = 0.3 }.tets\n"
                "for _, call in ipairs{ function() cube:mesh{ size = 1e-4 } end,\n"
                "    function() cdem.read_mesh{ file = 'bad.msh' } end,\n"
                "    function() cdem.solid.read{ file = 'bad.step' } end } do\n"
                "  local well, message = pcall(call)\n  assert(not well)\n"
                "  assert(cube:mesh{ size = 0.3 }.tets == before, message)\nend");
  script.write("bad.msh", "$MeshFormat\nnonsense\n");
  script.write("bad.step", "ISO-10303-21;\nnonsense\n");
  CHECK(script.error() == "");
}

TEST_CASE("a picture of a mesh is written as PNG and refuses fields that are not there", "[lua]") {
  Script script(solids_head +
                "cube:faces{ side = 'x+', name = 'held' }\n"
                "cube:picture{ file = 'm.png', colour = 'on_held', edges = 'mesh', size = {320, 240} }");
  script.run();
  CHECK(script.read("m.png").rfind("\x89PNG", 0) == 0);
  CHECK_THAT(error_of(solids_head + "cube:picture{ file = 'm.png', colour = 'on_head', size = {320, 240} }"),
             Contains("on_head"));
}
