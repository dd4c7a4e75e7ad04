// Piles in scripts: dropped, laid, saved, made a model of, measured.
#include "tests/lua/script.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// A cube as the unit, a slab 20 m by 20 m whose upper side is z = 2, and a drop of 12 in one layer.
const std::string piles_head =
    opening + "local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
              "local cube = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }\n"
              "local slab = cdem.box_mesh{ size = {20, 20, 2}, divisions = {2, 2, 1} }\n";
const std::string dropped =
    piles_head +
    "local pile = cdem.drop{ unit = cube, count = 12, onto = slab, seed = 3, gap = 0.2 }\n"
    "local model = cdem.model{ bodies = { { shape = pile, material = concrete, name = 'units' } } }\n";

} // namespace

TEST_CASE("a pile tells its units, and a scaled one has all lengths scaled", "[lua]") {
  CHECK(
      error_of(dropped +
               "assert(#pile == 12 and pile.count == 12)\nclose(pile.height, 1)\nclose(pile.unit_volume, 1)\n"
               "close(pile.nominal_diameter, 1)\n"
               "local large = pile:scaled{ factor = 2 }\n"
               "close(large.unit_volume, 8)\nclose(large.height, 2)\n"
               "for i, pose in ipairs(pile:poses()) do\n"
               "  for k = 1, 3 do close(large:poses()[i].centroid[k], 2 * pose.centroid[k]) end\n"
               "  for k = 1, 3 do assert(pose.centroid[k] - pile:box().min[k] > 0.5 - 1e-9) end\n"
               "  for k = 1, 3 do assert(pile:box().max[k] - pose.centroid[k] > 0.5 - 1e-9) end\n"
               "  assert(pose.centroid[3] > 2.5 + 0.2)\nend") == "");
}

TEST_CASE("a pile takes a finer mesh of its unit, and no other unit", "[lua]") {
  CHECK(error_of(dropped +
                 "local finer = cdem.box_mesh{ size = {1, 1, 1}, divisions = {3, 3, 3} }\n"
                 "local same = pile:with_unit{ unit = finer }\n"
                 "assert(#same == 12 and same.height == pile.height)\nclose(same.unit_volume, 1)\n"
                 "for i, pose in ipairs(same:poses()) do\n"
                 "  for k = 1, 3 do assert(pose.centroid[k] == pile:poses()[i].centroid[k]) end\nend") == "");
  CHECK_THAT(
      error_of(dropped + "pile:with_unit{ unit = cdem.box_mesh{ size = {1, 1, 2}, divisions = {1, 1, 1} } }"),
      Contains("unit = 2 m3: must be another mesh of the same unit"));
}

TEST_CASE("each unit of a pile becomes a block of its body", "[lua]") {
  CHECK(error_of(dropped +
                 "local c = model:counts()\nassert(c.blocks == 12 and c.tets == 72)\n"
                 "for i, block in ipairs(model:blocks()) do\n"
                 "  for k = 1, 3 do close(block.centroid[k], pile:poses()[i].centroid[k]) end\nend") == "");
}

TEST_CASE("units keep their numbers and places when others are removed", "[lua]") {
  CHECK(
      error_of(dropped +
               "local two = cdem.select.units{ body = 'units', numbers = {3, 8} }\n"
               "local highest = model:highest_units{ body = 'units', count = 12 }\n"
               "model:remove{ on = two }\n"
               "local left = model:pile{ body = 'units' }\nassert(#left == 10)\n"
               "local i = 0\nfor number = 1, 12 do if number ~= 3 and number ~= 8 then\n"
               "  i = i + 1\n"
               "  for k = 1, 3 do close(left:poses()[i].centroid[k], pile:poses()[number].centroid[k]) end\n"
               "end end\n"
               "local after = model:highest_units{ body = 'units', count = 10 }\n"
               "i = 0\nfor _, number in ipairs(highest) do if number ~= 3 and number ~= 8 then\n"
               "  i = i + 1\n  assert(after[i] == number)\nend end") == "");
}

TEST_CASE("contacts of the units that are left go by their numbers", "[lua]") {
  CHECK(error_of(piles_head +
                 "local pile = cdem.drop{ unit = cube, count = 12, onto = slab, seed = 3, gap = 0.2 }\n"
                 "local model = cdem.model{ bodies = {\n"
                 "  { shape = pile, material = concrete, name = 'units', element = 'rigid' },\n"
                 "  { shape = slab, material = concrete, name = 'floor', element = 'rigid' } } }\n"
                 "model:remove{ on = cdem.select.units{ body = 'units', numbers = {3, 8} } }\n"
                 "local rows = model:pile_measures{ body = 'units', onto = 'floor' }.contacts\n"
                 "local poses = model:pile{ body = 'units' }:poses()\n"
                 "assert(#rows == 10 and #poses == 10)\n"
                 "for i, number in ipairs{1, 2, 4, 5, 6, 7, 9, 10, 11, 12} do\n"
                 "  assert(rows[i].unit == number and rows[i].contacts == 0)\n"
                 "  assert(poses[i].unit == number and poses[i].pieces == 1)\n"
                 "end") == "");
}

TEST_CASE("a pile tells which of its units have broken, from a file too, and a body of it is warned of",
          "[lua]") {
  const std::string broken =
      piles_head +
      "local bar = cdem.box_mesh{ size = {2, 1, 1}, divisions = {4, 1, 1} }\n"
      "local pile = cdem.drop{ unit = bar, count = 3, onto = slab, seed = 3, gap = 0.2 }\n"
      "local joint = cdem.mohr_coulomb{ cohesion = 4e6, friction_angle = 30, tensile_strength = 2e6 }\n"
      "local model = cdem.model{ bodies = { { shape = pile, material = concrete, joint = joint, bonds = "
      "'springs',\n"
      "                                       name = 'units' } } }\n"
      "assert(pile.broken == 0 and model:pile{ body = 'units' }.broken == 0)\n"
      "local c = pile:poses()[2].centroid\n"
      "local around = cdem.select.box{ min = {c[1] - 1.3, c[2] - 1.3, c[3] - 1.3},\n"
      "                                max = {c[1] + 1.3, c[2] + 1.3, c[3] + 1.3} }\n"
      "model:break_bonds{ on = around }\n"
      "local now = model:pile{ body = 'units' }\n";
  const std::string told = "assert(now.broken == 1)\n"
                           "for i, pose in ipairs(now:poses()) do\n"
                           "  assert(pose.unit == i and pose.pieces == (i == 2 and 24 or 1))\n"
                           "  close(pose.largest_piece, i == 2 and 1 / 24 or 1)\nend\n";
  CHECK(error_of(broken + told +
                 "now:save{ file = 'broken.json' }\nnow = cdem.read_pile{ file = 'broken.json' }\n" + told) ==
        "");
  const auto warned = [&](const std::string& shape) {
    const std::vector<std::string> warnings = warnings_of(
        broken + "cdem.model{ bodies = { { shape = " + shape + ", material = concrete, name = 'units' } } }");
    return std::count_if(warnings.begin(), warnings.end(), [](const std::string& line) {
      return line.find("1 unit of the pile had broken when it was taken; the body gets whole ones") !=
             std::string::npos;
    });
  };
  CHECK(warned("now:scaled{ factor = 2 }") == 1);
  CHECK(warned("pile") == 0);
}

TEST_CASE("conditions work on chosen units alone", "[lua]") {
  CHECK(error_of(
            dropped +
            "model:fix{ on = cdem.select.units{ body = 'units', numbers = {7, 2} }, velocity = {0, 0, 1} }\n"
            "model:run{ steps = 1, time_step = 1e-6 }\n"
            "for i, block in ipairs(model:blocks()) do\n"
            "  assert((block.displacement[3] > 0) == (i == 2 or i == 7), i)\nend") == "");
}

TEST_CASE("faces named on the unit's mesh are a place on every unit, from a file too", "[lua]") {
  const std::string named =
      piles_head + "cube:faces{ side = 'z-', name = 'foot' }\n"
                   "local pile = cdem.drop{ unit = cube, count = 12, onto = slab, seed = 3, gap = 0.2 }\n"
                   "pile:save{ file = 'pile.json' }\n"
                   "pile = cdem.read_pile{ file = 'pile.json' }:scaled{ factor = 2 }\n"
                   "local model = cdem.model{ bodies = { { shape = pile, material = concrete, "
                   "name = 'units' } } }\n";
  CHECK(error_of(named +
                 "local foot = cdem.select.faces{ body = 'units', name = 'foot' }\n"
                 "model:fix{ on = foot }\nmodel:gravity{ vector = {0, 0, -9.81} }\n"
                 "model:select{ name = 'feet', on = cdem.select.faces{ name = 'foot' } }\nmodel:relax{}\n"
                 "assert(model:max('displacement.magnitude', 'feet') == 0)\n"
                 "assert(model:max('displacement.magnitude', 'units') > 0)\n"
                 "close(model:reaction(foot)[3], 12 * 8 * 2500 * 9.81, 1e-4)") == "");
  CHECK_THAT(
      error_of(named + "model:fix{ on = cdem.select.faces{ body = 'units', name = 'foto' } }"),
      Contains(
          "name = \"foto\": no faces of body \"units\" have that name; did you mean foot? There are: foot"));
  CHECK_THAT(error_of(named + "model:traction{ on = cdem.select.faces{ body = 'unit', name = 'foot' }, "
                              "stress = {0, 0, 1} }"),
             Contains("body = \"unit\": must be the name of a body"));
  CHECK_THAT(
      error_of(dropped + "model:fix{ on = cdem.select.faces{ name = 'foot' } }"),
      Contains("have a name; mesh:faces{ ..., name = \"foot\" } gives them one, before the model is made"));
}

TEST_CASE("the lowest and highest units are those whose centroids are so now", "[lua]") {
  CHECK(
      error_of(dropped +
               "local five = cdem.select.units{ body = 'units', numbers = {5} }\n"
               "model:fix{ on = five, velocity = {0, 0, -1e6} }\n"
               "model:run{ steps = 2, time_step = 1e-6 }\n"
               "assert(model:lowest_units{ body = 'units', count = 1 }[1] == 5)\n"
               "assert(model:highest_units{ body = 'units', count = 12 }[12] == 5)\n"
               "local low = model:lowest_units{ body = 'units', count = 3, up = {1, 0, 0} }\n"
               "local x = {}\n"
               "for i, pose in ipairs(model:pile{ body = 'units' }:poses()) do x[i] = pose.centroid[1] end\n"
               "local sorted = { table.unpack(x) }\ntable.sort(sorted)\n"
               "for i = 1, 3 do close(x[low[i]], sorted[i]) end") == "");
}

TEST_CASE("the pile of a model follows its units", "[lua]") {
  CHECK(error_of(dropped + "local before = pile:poses()[4]\n"
                           "model:fix{ on = cdem.select.units{ body = 'units', numbers = {4} }, velocity = "
                           "{0.5, 0, 2} }\n"
                           "model:run{ steps = 1000, time_step = 1e-5 }\n"
                           "local after = model:pile{ body = 'units' }:poses()[4]\n"
                           "close(after.centroid[1] - before.centroid[1], 0.005, 1e-6)\n"
                           "close(after.centroid[3] - before.centroid[3], 0.02, 1e-6)\n"
                           "for i = 1, 3 do for k = 1, 3 do\n"
                           "  close(after.rotation[i][k], before.rotation[i][k], 1e-9)\nend end") == "");
}

TEST_CASE("a pile comes back from its file to the last digit", "[lua]") {
  CHECK(error_of(dropped +
                 "pile:save{ file = 'pile.json' }\n"
                 "local again = cdem.read_pile{ file = 'pile.json' }\n"
                 "assert(#again == 12 and again.height == pile.height)\n"
                 "for i, pose in ipairs(again:poses()) do\n"
                 "  for k = 1, 3 do\n"
                 "    assert(pose.centroid[k] == pile:poses()[i].centroid[k])\n"
                 "    for j = 1, 3 do assert(pose.rotation[k][j] == pile:poses()[i].rotation[k][j]) end\n"
                 "  end\nend\n"
                 "assert(again.unit_volume == pile.unit_volume)") == "");
}

TEST_CASE("a layer of cubes has the density it was laid with", "[lua]") {
  CHECK(error_of(piles_head +
                 "local layer = cdem.place{ unit = cube, count = 25, onto = slab, columns = 5, density = "
                 "0.3, nudges = 20, attitudes = 50 }\n"
                 "assert(#layer == 25)\n"
                 "for _, pose in ipairs(layer:poses()) do assert(pose.centroid[3] < 3) end") == "");
}

TEST_CASE("a layer of armour units stays as it was laid when it settles", "[lua]") {
  // The first row is held, as at a toe. No unit moves by a tenth of its height.
  CHECK(error_of(piles_head +
                 "local unit = cdem.accropode{ height = 1, corner = 0 }:mesh{ size = 0.5 }\n"
                 "local slope = cdem.slope{ gradient = 2 / 3, length = 6, width = 7 }:mesh{ size = 3 }\n"
                 "local pile = cdem.place{ unit = unit, count = 12, onto = slope, columns = 4 }\n"
                 "local rough = cdem.coulomb{ friction_angle = 40 }\n"
                 "local model = cdem.model{\n"
                 "  bodies = { { shape = slope, material = concrete, element = 'rigid', name = 'slope' },\n"
                 "             { shape = pile, material = concrete, name = 'units' } },\n"
                 "  contacts = { { 'units', 'units', rough }, { 'units', 'slope', rough } } }\n"
                 "model:fix{ on = 'slope' }\n"
                 "model:fix{ on = cdem.select.units{ body = 'units', numbers = {1, 2, 3, 4} } }\n"
                 "model:gravity{ vector = {0, 0, -9.81} }\n"
                 "model:settle{ kinetic_energy_ratio = 1e-4 }\n"
                 "for i, pose in ipairs(model:pile{ body = 'units' }:poses()) do\n"
                 "  local from, way = pile:poses()[i].centroid, 0\n"
                 "  for k = 1, 3 do way = way + (pose.centroid[k] - from[k]) ^ 2 end\n"
                 "  assert(math.sqrt(way) <= 0.1, i .. ' has moved by ' .. math.sqrt(way))\nend") == "");
}

TEST_CASE("two layers of armour units stay as they were laid when they settle between walls", "[lua]") {
  // The lowest row of each layer is held, as at a toe. No unit moves by a fiftieth of its height.
  CHECK(
      error_of(piles_head +
               "local unit = cdem.accropode{ height = 1, corner = 0 }:mesh{ size = 0.5 }\n"
               "local slope = cdem.slope{ gradient = 2 / 3, length = 4, width = 6 }:mesh{ size = 3 }\n"
               "local pile = cdem.place{ unit = unit, count = 12, layers = 2, onto = slope, columns = 3,\n"
               "                         friction_angle = 12, walls = true }\n"
               "local model = cdem.model{\n"
               "  bodies = { { shape = slope, material = concrete, element = 'rigid', name = 'slope' },\n"
               "             { shape = pile, material = concrete, element = 'rigid', name = 'units' },\n"
               "             { shape = pile:walls{ onto = slope }, material = concrete, element = 'rigid',\n"
               "               name = 'walls' } },\n"
               "  contacts = { default = cdem.coulomb{ friction_angle = 35 } } }\n"
               "model:fix{ on = {'slope', 'walls'} }\n"
               "model:fix{ on = cdem.select.units{ body = 'units', numbers = {1, 2, 3, 7, 8, 9} } }\n"
               "model:gravity{ vector = {0, 0, -9.81} }\n"
               "model:settle{ kinetic_energy_ratio = 1e-4, friction_angle = 15 }\n"
               "for i, pose in ipairs(model:pile{ body = 'units' }:poses()) do\n"
               "  local from, way = pile:poses()[i].centroid, 0\n"
               "  for k = 1, 3 do way = way + (pose.centroid[k] - from[k]) ^ 2 end\n"
               "  assert(math.sqrt(way) <= 0.02, i .. ' has moved by ' .. math.sqrt(way))\nend") == "");
}

TEST_CASE("default is the law between meshed bodies, and between the units of one", "[lua]") {
  // Three cubes fall on the slab and on each other.
  const std::string fall =
      piles_head +
      "local rough = cdem.coulomb{ friction_angle = 30 }\n"
      "local pile = cdem.drop{ unit = cube, count = 3, onto = slab, layers = 3, gap = 0.02,\n"
      "  region = { min = {9, 9}, max = {11, 11} } }\n"
      "local function fallen(contacts)\n"
      "  local model = cdem.model{\n"
      "    bodies = { { shape = slab, material = concrete, element = 'rigid', name = 'slab' },\n"
      "               { shape = pile, material = concrete, element = 'rigid', name = 'units' } },\n"
      "    contacts = contacts }\n"
      "  model:fix{ on = 'slab' }\n  model:gravity{ vector = {0, 0, -9.81} }\n"
      "  model:run{ duration = 0.5 }\n"
      "  return model.state_hash\nend\n";
  CHECK(error_of(fall +
                 "local all = fallen{ { 'slab', 'slab', rough }, { 'units', 'slab', rough },\n"
                 "                    { 'units', 'units', rough } }\n"
                 "assert(fallen{ default = rough } == all)\n"
                 "local smooth = cdem.coulomb{ friction_angle = 0 }\n"
                 "assert(fallen{ default = smooth } ~= all)\n"
                 "assert(fallen{ default = smooth, { 'slab', 'units', rough }, { 'units', 'units', rough } }"
                 " == all)") == "");
  CHECK_THAT(error_of(fall + "fallen{ default = cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, "
                             "tensile_strength = 1e6 } }"),
             Contains("contacts.default = a joint that bonds: must be cdem.coulomb"));
}

TEST_CASE("walls keep a dropped pile on a slope together", "[lua]") {
  // Nothing is held but the slope and the walls; without walls the cubes roll down and off the slope.
  CHECK(
      error_of(piles_head +
               "local slope = cdem.slope{ gradient = 0.5, length = 8, width = 8 }:mesh{ size = 2 }\n"
               "local pile = cdem.drop{ unit = cube, count = 6, onto = slope, seed = 2 }\n"
               "local model = cdem.model{\n"
               "  bodies = { { shape = pile, material = concrete, element = 'rigid', name = 'units' },\n"
               "             { shape = slope, material = concrete, element = 'rigid', name = 'slope' },\n"
               "             { shape = pile:walls{ onto = slope }, material = concrete, element = 'rigid',\n"
               "               name = 'walls' } },\n"
               "  contacts = { default = cdem.coulomb{ friction_angle = 20 } } }\n"
               "model:fix{ on = {'slope', 'walls'} }\nmodel:gravity{ vector = {0, 0, -9.81} }\n"
               "local rest = model:settle{ kinetic_energy_ratio = 1e-8, max_time = 20 }\n"
               "assert(rest.converged)\n"
               "local before, after = pile:box(), model:pile{ body = 'units' }:box()\n"
               "assert(after.min[1] > before.min[1] - 0.01)\n"
               "for k = 1, 2 do assert(after.max[k] < before.max[k] + 0.01) end\n"
               "assert(after.min[2] > before.min[2] - 0.01)\n"
               "local weight = 6 * 2500 * 9.81\n"
               "local carried = model:reaction('slope')[3] + model:reaction('walls')[3]\n"
               "local own = 2500 * 9.81 * (slope:volume() + pile:walls{ onto = slope }:volume())\n"
               "assert(math.abs((carried - own) / weight - 1) < 0.01, (carried - own) / weight)") == "");
}

TEST_CASE("piles that cannot be made are refused", "[lua]") {
  const auto refused = [](const std::string& call) { return error_of(piles_head + call); };
  CHECK_THAT(refused("cdem.drop{ unit = cube, count = 0, onto = slab }"), Contains("count = 0: must be"));
  CHECK_THAT(refused("cdem.drop{ unit = cube, count = 2, onto = slab, gap = -1 }"),
             Contains("gap = -1: must be > 0"));
  CHECK_THAT(
      refused(
          "cdem.drop{ unit = cube, count = 2, onto = slab, region = { min = {50, 50}, max = {60, 60} } }"),
      Contains("must be over the ground"));
  CHECK_THAT(
      refused("cdem.drop{ unit = cube, count = 2, onto = slab, region = { min = {5}, max = {6, 6} } }"),
      Contains("region.min"));
  CHECK_THAT(refused("cdem.place{ unit = cube, count = 2, onto = slab, density = 9 }"),
             Contains("density = 9: must be"));
  CHECK_THAT(refused("cdem.drop{ unit = cube, count = 2, onto = slab }:save{ file = 'pile.csv' }"),
             Contains("ends in .json"));
  CHECK_THAT(refused("cdem.drop{ unit = cube, count = 2, onto = slab }:walls{ onto = slab, height = 0 }"),
             Contains("height = 0: must be"));
  CHECK_THAT(refused("cdem.drop{ unit = cube, count = 2, onto = slab }:scaled{ factor = 0 }"),
             Contains("factor = 0: must be > 0"));
  CHECK_THAT(refused("cdem.select.units{ body = 'units', numbers = {0} }"), Contains("must be"));
  const std::string two =
      "local function box(x) return cdem.solid.box{ size = {1, 1, 1}, origin = {x, 0, 0} } end\n"
      "local two = cdem.solid.union{ solids = { box(0), box(3) } }:mesh{ size = 1 }\n";
  CHECK_THAT(refused(two + "cdem.place{ unit = two, count = 2, onto = slab }"),
             Contains("unit = a mesh of 2 parts: must be one that hangs together"));
}

TEST_CASE("units that a model does not have are refused", "[lua]") {
  const auto refused = [](const std::string& call) { return error_of(dropped + call); };
  CHECK_THAT(refused("model:fix{ on = cdem.select.units{ body = 'units', numbers = {3, 13} } }"),
             Contains("numbers = 13: must be a unit of \"units\", which has 12"));
  CHECK_THAT(refused("model:fix{ on = cdem.select.units{ body = 'unit', numbers = {3} } }"),
             Contains("body = \"unit\": must be the name of a body"));
  CHECK_THAT(refused("model:pile{ body = 'stones' }"), Contains("body = \"stones\": no such body"));
  CHECK_THAT(refused("model:pile_measures{ body = 'units', onto = 'slope' }"),
             Contains("onto = \"slope\": no such body"));
  CHECK_THAT(refused("model:lowest_units{ body = 'units', count = 13 }"), Contains("at most 12"));
}

TEST_CASE("a pile's file that is none is refused, and units inside each other", "[lua]") {
  const std::string poses = "{\"centroid\": [0, 0, 0], \"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}";
  const auto file = [](const std::string& given, const std::string& version = "cdem pile 1",
                       const std::string& faces = "") {
    return "{\"format\": \"" + version + "\", \"height\": 1, \"poses\": [" + given +
           "], \"nodes\": [[-0.25, -0.25, -0.25], [0.75, -0.25, -0.25], [-0.25, 0.75, -0.25], "
           "[-0.25, -0.25, 0.75]], \"tets\": [[0, 1, 2, 3]], \"regions\": [0]" +
           faces + "}";
  };
  const auto refused = [](const std::string& text, const std::string& more = "") {
    Script script(piles_head + "local pile = cdem.read_pile{ file = 'pile.json' }\n" + more);
    script.write("pile.json", text);
    return script.error();
  };
  CHECK(refused(file(poses)) == "");
  const std::string needed = "; a whole file that pile:save{} wrote is needed: write it anew";
  const std::string whole = file(poses);
  for (const std::size_t bytes : {whole.size() - 1, whole.size() / 2, whole.find("0.75") + 2, std::size_t{9}})
    CHECK_THAT(refused(whole.substr(0, bytes) + "\n"),
               Contains("pile.json: ends in the middle, after ") && Contains(" bytes" + needed));
  CHECK_THAT(refused(""), Contains("pile.json: is empty" + needed));
  CHECK_THAT(refused("solid cube"), Contains("pile.json: is no pile" + needed));
  const auto garbled = [&](const std::string& part, const std::string& other) {
    std::string text = whole;
    return refused(text.replace(text.find(part), part.size(), other));
  };
  const std::string byte = std::to_string(whole.find("0.75") + 1);
  for (const std::string number : {"0.7x5", "0.7.5", "0x75", "nan", "0.", "--75", "0.75abc"})
    CHECK_THAT(garbled("0.75", number),
               Contains("pile.json: \"" + number + "\" at byte " + byte + " is not a number" + needed));
  CHECK_THAT(garbled("0.75", "null"), Contains("pile.json: nodes[2] = null is not a number" + needed));
  CHECK_THAT(garbled("0.75", "1e999"), Contains("pile.json: ") && Contains(needed));
  CHECK_THAT(garbled("0.75,", "0.75,,"), Contains("pile.json: cannot be read at byte ") && Contains(needed));
  CHECK_THAT(garbled("0.75, ", ""), Contains("pile.json: nodes[2] is not a list of 3" + needed));
  CHECK_THAT(garbled("[0, 1, 2, 3]", "[0, 1, 2, 3.5]"),
             Contains("pile.json: tets[1] = 3.5 is not a whole number"));
  for (const std::string key : {"format", "height", "poses", "nodes", "tets", "regions"})
    CHECK_THAT(garbled("\"" + key + "\"", "\"" + key + "s\""),
               Contains("pile.json: \"" + key + "\" is missing" + needed));
  CHECK_THAT(garbled("\"centroid\"", "\"center\""),
             Contains("pile.json: poses[1]: \"centroid\" is missing" + needed));
  CHECK_THAT(refused(file(poses, "other")), Contains("pile.json: format = \"other\""));
  CHECK_THAT(refused(file("")), Contains("the pile has no units"));
  CHECK_THAT(refused(file(poses, "cdem pile 1", ", \"faces\": {\"foot\": [4]}")),
             Contains("faces \"foot\" = 4: must be the number of an outer face, below 4"));
  CHECK_THAT(refused(file("{\"centroid\": [0, 0, 0], \"rotation\": [[1, 0, 0], [0, 2, 0], [0, 0, 1]]}")),
             Contains("pose 1: its matrix is no rotation"));
  const std::string model = "cdem.model{ bodies = { { shape = pile, material = concrete } } }";
  CHECK_THAT(refused(file(poses + ", " +
                          "{\"centroid\": [0.1, 0.1, 0.1], \"rotation\": [[1, 0, 0], [0, 1, 0], "
                          "[0, 0, 1]]}"),
                     model),
             Contains("body_1"));
}

TEST_CASE("lists nested without end in a pile are refused before they are parsed", "[lua]") {
  const auto refused = [](const std::string& text) {
    Script script("require('cdem').read_pile{ file = 'pile.json' }");
    script.write("pile.json", text);
    return script.error();
  };
  for (const std::size_t depth : {std::size_t{65}, std::size_t{1000000}}) {
    INFO(depth);
    CHECK_THAT(refused("{\"format\":" + std::string(depth, '[') + std::string(depth, ']') + "}"),
               Contains("nests lists too deeply"));
    CHECK_THAT(refused(std::string(depth, '[')), Contains("nests lists too deeply"));
  }
  // Brackets within a text nest nothing.
  CHECK_THAT(refused("{\"format\":\"" + std::string(100, '[') + "\\\"[\"}"), Contains("format = "));
}
