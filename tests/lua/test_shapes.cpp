#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string shapes_head =
    "local cdem = require 'cdem'\n"
    "local function close(a, b) assert(math.abs(a - b) < 1e-12, a .. ' is not ' .. b) end\n"
    "local function corners(shape, min, max)\n  local box = shape:box()\n"
    "  for i = 1, 3 do close(box.min[i], min[i]) close(box.max[i], max[i]) end\nend\n";

} // namespace

TEST_CASE("a grid has as many blocks as divisions and fills its box", "[lua]") {
  CHECK(error_of(shapes_head +
                 "local g = cdem.grid{ size = {2, 3, 4}, divisions = {2, 3, 4}, origin = {1, 1, 1} }\n"
                 "assert(#g == 24)\nclose(g:volume(), 24)\ncorners(g, {1, 1, 1}, {3, 4, 5})\n"
                 "local blocks = g:blocks()\nassert(#blocks == 24 and blocks[1].faces == 6 and "
                 "#blocks[1].vertices == 8)\n"
                 "close(blocks[1].volume, 1)\nassert(tostring(g) == 'cdem.Assembly (24 blocks)')") == "");
}

TEST_CASE("every builder fills the volume it was given", "[lua]") {
  CHECK(error_of(
            shapes_head +
            "close(cdem.box{ size = {1, 2, 3} }:volume(), 6)\n"
            "local v = cdem.voronoi{ size = {1, 1, 1}, count = 20, seed = 3 }\nassert(#v == 20)\n"
            "assert(math.abs(v:volume() - 1) < 1e-10)\n"
            "assert(math.abs(cdem.bricks{ size = {4, 1, 2}, brick = {1, 1, 0.5} }:volume() - 8) < 1e-10)\n"
            "local cube = cdem.box{ size = {1, 1, 1} }\n"
            "local cut = cdem.cut_by_joints{ shape = cube, sets = { { dip = 60, dip_direction = 90, spacing "
            "= 0.3 } } }\n"
            "assert(#cut > 1)\nassert(math.abs(cut:volume() - 1) < 1e-10)\n"
            "close(cdem.convex_hull{ points = { {0,0,0}, {1,0,0}, {0,1,0}, {0,0,1} } }:volume(), 1 / 6)") ==
        "");
}

TEST_CASE("assemblies are cut, moved, turned and joined into new ones", "[lua]") {
  CHECK(error_of(shapes_head +
                 "local a = cdem.box{ size = {2, 1, 1} }\n"
                 "corners(cdem.translate{ shape = a, shift = {1, 2, 3} }, {1, 2, 3}, {3, 3, 4})\n"
                 "corners(cdem.rotate{ shape = a, axis = {0, 0, 2}, angle = 90 }, {-1, 0, 0}, {0, 2, 1})\n"
                 "corners(a, {0, 0, 0}, {2, 1, 1})\n"
                 "local cut = cdem.cut_by_plane{ shape = a, point = {0.5, 0, 0}, normal = {3, 0, 0} }\n"
                 "assert(#cut == 2 and #a == 1)\nclose(cut:blocks()[1].volume, 0.5)\n"
                 "assert(#cdem.merge{ shapes = { a, cut } } == 3)") == "");
}

TEST_CASE("a cut within rounding of a face leaves a block whole, and one that leaves a splinter is told of",
          "[lua]") {
  const auto lines = [](const std::string& z) {
    Script script("local cdem = require 'cdem'\n"
                  "local cut = cdem.cut_by_plane{ shape = cdem.box{ size = {2, 1, 1} }, point = {0, 0, " +
                  z + "}, normal = {0, 0, 1} }\nprint('blocks ' .. #cut)");
    script.run();
    std::string all;
    for (const std::string& line : script.listener->lines)
      all += line + "\n";
    return all;
  };
  const std::string in_face = lines("1 - 1e-12"), splinter = lines("1 - 1e-6"), plain = lines("0.99");
  CHECK_THAT(in_face, Contains("blocks 1") && !Contains("warning"));
  CHECK_THAT(splinter, Contains("blocks 2") &&
                           Contains("1 block thinner than a ten-thousandth of its size") &&
                           Contains("1e-06 m at"));
  CHECK_THAT(plain, Contains("blocks 2") && !Contains("warning"));
}

TEST_CASE("builders refuse what cannot be built", "[lua]") {
  CHECK_THAT(error_of(shapes_head + "cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 0} }"),
             Contains("divisions[3] = 0: must be >= 1"));
  CHECK_THAT(error_of(shapes_head + "cdem.grid{ size = {1, 1, 1} }"),
             Contains("divisions: missing; must be three whole numbers"));
  CHECK_THAT(error_of(shapes_head + "cdem.voronoi{ size = {1, 1, 1}, count = -2 }"),
             Contains("count = -2: must be >= 1"));
  CHECK_THAT(error_of(shapes_head + "cdem.convex_hull{ points = { {0,0,0}, {1,0,0}, {0,1,0} } }"),
             Contains("at least 4 items"));
  CHECK_THAT(error_of(shapes_head + "cdem.convex_hull{ points = { {0,0,0}, {1,0,0}, {0,1,0}, {1,1,0} } }"),
             Contains("case.lua:7: cdem.convex_hull: "));
  CHECK_THAT(
      error_of(shapes_head +
               "cdem.cut_by_plane{ shape = cdem.box{ size = {1,1,1} }, point = {0,0,0}, normal = {0,0,0} }"),
      Contains("normal = {0, 0, 0}: must be longer than zero"));
}
