// Meshed bodies, flow and the search for the critical flow in scripts.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string meshes_head =
    opening +
    "local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
    "local bond = cdem.mohr_coulomb{ cohesion = 5e6, friction_angle = 35, tensile_strength = 2e6 }\n"
    "local cube = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }\n"
    "local function model_of(body)\n"
    "  body.shape, body.material = body.shape or cube, concrete\n  return cdem.model{ bodies = { body } "
    "}\nend\n";

const std::string held = meshes_head + "local model = model_of{ joint = bond }\nmodel:fix{ on = 'z-' }\n";

// Two cubes of 1 m, one on the other, as regions 1 and 2 of one mesh.
const std::string tower =
    meshes_head + "local tower = cdem.solid.fragments{ solids = { cdem.solid.box{ size = {1, 1, 1} },\n"
                  "  cdem.solid.box{ size = {1, 1, 1}, origin = {0, 0, 1} } } }:mesh{ size = 0.6 }\n";

} // namespace

TEST_CASE("a meshed body has bonds where its joint is asked for", "[lua]") {
  // 8 cells of 6 tets, 48 outer faces: (4 * 48 - 48) / 2 = 72 inner ones with three bonds each.
  CHECK(error_of(meshes_head +
                 "local c = model_of{}:counts()\n"
                 "assert(c.blocks == 1 and c.tets == 48 and c.nodes == 27 and c.bonds == 0)\n"
                 "c = model_of{ joint = bond }:counts()\n"
                 "assert(c.tets == 48 and c.nodes == 27 and c.bonds == 0)\n"
                 "c = model_of{ joint = bond, bonds = 'springs' }:counts()\n"
                 "assert(c.tets == 48 and c.nodes == 192 and c.bonds == 216 and c.intact == 216)\n"
                 "c = model_of{ joint = cdem.coulomb{ friction_angle = 35 }, bonds = 'springs' }:counts()\n"
                 "assert(c.bonds == 216 and c.contacts == 216)") == "");
}

TEST_CASE("bonds between regions alone let a body part there alone", "[lua]") {
  CHECK(error_of(tower + "local whole = model_of{ shape = tower }:counts()\n"
                         "local model = model_of{ shape = tower, joint = bond, bonds = 'springs', "
                         "bonded_faces = 'regions' }\n"
                         "local c = model:counts()\n"
                         "assert(c.nodes > whole.nodes and c.bonds > 0 and c.tets == whole.tets)\n"
                         "local listed = model_of{ shape = tower, joint = bond, bonds = 'springs', "
                         "bonded_regions = {2} }:counts()\n"
                         "assert(listed.bonds > c.bonds and listed.nodes > c.nodes)\n"
                         "model:fix{ on = 'z-' }\n"
                         "assert(#model:fragments() == 1)\nclose(model:fragments()[1].volume, 2)\n"
                         "local plane = cdem.select.plane{ point = {0, 0, 1}, normal = {0, 0, 1} }\n"
                         "assert(model:break_bonds{ on = plane } == c.bonds)\n"
                         "local pieces = model:fragments()\nassert(#pieces == 2)\n"
                         "for _, piece in ipairs(pieces) do\n"
                         "  close(piece.volume, 1)\n  assert(piece.held == (piece.centroid[3] < 1))\nend") ==
        "");
}

TEST_CASE("a box mesh stands where its origin is", "[lua]") {
  CHECK(
      error_of(opening +
               "local box = cdem.box_mesh{ size = {1, 2, 3}, divisions = {1, 2, 3}, origin = {5, -1, 0.5} "
               "}:box()\n"
               "for i, low in ipairs{5, -1, 0.5} do close(box.min[i], low) close(box.max[i], low + i) end") ==
      "");
}

TEST_CASE("a meshed body under its weight: reaction, stress and energy", "[lua]") {
  CHECK(error_of(meshes_head + "local model = model_of{}\nmodel:fix{ on = 'z-' }\n"
                               "model:gravity{ vector = {0, 0, -9.81} }\n"
                               "assert(model:relax{ residual = 1e-8 }.converged)\n"
                               "close(model:reaction('z-')[3], 2500 * 9.81, 1e-6)\n"
                               "close(model:mean('stress.zz'), -2500 * 9.81 / 2, 1e-3)\n"
                               "assert(model:max('displacement.z') < 1e-9)\n"
                               "assert(model:energy().balance_error < 1e-2)") == "");
}

TEST_CASE("a rigid mesh falls as a whole, and deforms when it is let", "[lua]") {
  CHECK(error_of(meshes_head + "local model = model_of{ element = 'rigid' }\n"
                               "assert(model.stable_time_step == math.huge)\n"
                               "model:gravity{ vector = {0, 0, -10} }\n"
                               "model:run{ duration = 0.1, time_step = 1e-3 }\n"
                               "close(model:max('displacement.z'), -0.05, 1e-9)\n"
                               "close(model:min('displacement.z'), -0.05, 1e-9)\n"
                               "assert(model:make_deformable{ on = 'all' } == 1)\n"
                               "assert(model:make_deformable{ on = 'all' } == 0)\n"
                               "assert(model.stable_time_step < 1)\n"
                               "model:run{ steps = 10 }\n"
                               "assert(model:make_rigid{ on = 'all' } == 1)") == "");
  CHECK_THAT(error_of(meshes_head + "model_of{ element = 'rigid' }:run{ steps = 3 }"),
             Contains("time_step: missing"));
  CHECK_THAT(error_of(meshes_head + "model_of{ element = 'rigid' }:relax{}"), Contains("is rigid and free"));
  CHECK_THAT(error_of(meshes_head +
                      "model_of{}:make_rigid{ on = cdem.select.box{ min = {9, 9, 9}, max = {10, 10, 10} } }"),
             Contains("centroids of meshed bodies"));
}

TEST_CASE("a watch is a list that grows while the model runs", "[lua]") {
  CHECK(error_of(meshes_head +
                 "local model = model_of{ element = 'rigid', name = 'units' }\n"
                 "local left = model:watch{ body = 'units', leaves = 0.5 }\n"
                 "assert(#left == 0 and left[1] == nil and tostring(left) == 'cdem.Watch (0 left)')\n"
                 "model:initial_velocity{ velocity = {2, 0, 0} }\n"
                 "model:run{ time_step = 1e-3, stop = function() return #left >= 1 or model.time > 3 end }\n"
                 "assert(#left == 1 and left[1].unit == 1 and left[1].velocity == nil)\n"
                 "assert(left[1].time >= 0.25 and left[1].time < 0.31)\n"
                 "close(left[1].place[1], 0.5 + 2 * left[1].time)\n"
                 "close(left[1].displacement[1], 2 * left[1].time)\n"
                 "for i, unit in ipairs(left) do assert(i == 1 and unit.unit == 1) end") == "");
  CHECK_THAT(error_of(meshes_head + "model_of{}:watch{ body = 'rocks', leaves = 1 }"),
             Contains("body = \"rocks\": must be the name of a body"));
}

TEST_CASE("meshed bodies that do not fit are refused", "[lua]") {
  const auto refused = [](const std::string& body) {
    return error_of(meshes_head + "model_of{ " + body + " }");
  };
  CHECK_THAT(refused("element = 'small_strain'"),
             Contains("bodies[1].element = \"small_strain\": must be finite_volume or rigid for a mesh"));
  CHECK_THAT(refused("bonds = 'springs'"), Contains("bodies[1].joint: missing; bonds = \"springs\""));
  CHECK_THAT(refused("joint = bond, bonds = 'none'"), Contains("bodies[1].bonds = \"none\""));
  CHECK_THAT(refused("joint = bond, bonds = 'some'"), Contains("bonds = \"some\": must be one of"));
  CHECK_THAT(refused("joint = bond, bonds = 'listed'"), Contains("bodies[1].bonded_regions: missing"));
  CHECK_THAT(refused("bonded_regions = {1}"), Contains("bodies[1].bonded_regions: goes with a joint"));
  CHECK_THAT(refused("bonded_faces = 'regions'"), Contains("bodies[1].bonded_faces: goes with a joint"));
  CHECK_THAT(refused("joint = bond, bonded_faces = 'regions', bonded_regions = {1}"), Contains("not both"));
  CHECK_THAT(refused("joint = cdem.coulomb{ friction_angle = 35 }"),
             Contains("needs a tensile_strength and a cohesion") && Contains("springs"));
  for (const std::string region : {"0", "2", "-1"})
    CHECK_THAT(refused("joint = bond, bonded_regions = {" + region + "}"),
               Contains("= " + region + ": must be a region of the mesh (1 to 1)"));
  CHECK_THAT(refused("joint = bond, stiffness_ratio = 0"), Contains("stiffness_ratio = 0: must be > 0"));
  CHECK_THAT(refused("joint = bond, stiffness_ratio = 1e5"), Contains("stiffness_ratio = 100000: must be"));
  CHECK_THAT(refused("joint = bond, shear_ratio = -1"), Contains("shear_ratio = -1: must be > 0"));
  CHECK_THAT(refused("bonds = 'springs', joint = cdem.mohr_coulomb{ cohesion = 5e6, friction_angle = 35, "
                     "tensile_strength = 2e6, "
                     "softening = 'linear', fracture_energy_1 = 100, fracture_energy_2 = 400 }"),
             Contains("softening") && Contains("bonds = \"cohesive\" softens"));
  CHECK_THAT(error_of(meshes_head +
                      "cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, material = "
                      "concrete, bonds = 'springs' } } }"),
             Contains("bodies[1].joint: missing; bonds = \"springs\""));
}

TEST_CASE("a mesh that touches a block needs a law between them, and small strain knows none", "[lua]") {
  const auto beside = [](const std::string& origin, const std::string& more) {
    return error_of(meshes_head +
                    "cdem.model{ bodies = { { shape = cube, material = concrete, name = 'unit' },\n"
                    "  { shape = cdem.box{ size = {1, 1, 1}, origin = {" +
                    origin + "} }, material = concrete, name = 'slope', " + more);
  };
  const std::string no_law = " } } }",
                    law = " } }, contacts = { default = cdem.coulomb{ friction_angle = 30 } } }";
  CHECK_THAT(beside("1, 0, 0", no_law), Contains("\"unit\"") && Contains("\"slope\"") &&
                                            Contains("touch and no contact between them is given"));
  CHECK(beside("1, 0, 0", law) == "");
  CHECK_THAT(beside("0.5, 0.2, 0.2", law), Contains("stand in each other"));
  CHECK(beside("1.1, 0, 0", no_law) == "");
  CHECK_THAT(beside("1, 0, 0", "element = 'small_strain'" + law),
             Contains("blocks of small strain meet nothing new"));
}

TEST_CASE("cutting and growing refuse a model with meshed bodies", "[lua]") {
  for (const std::string call : {"refine{ shear_threshold = 1e5 }", "grow{}"}) {
    INFO(call);
    CHECK_THAT(error_of(held + "model:" + call), Contains("the model has meshed bodies"));
  }
  CHECK_THAT(error_of(meshes_head +
                      "model_of{ joint = bond, bonds = 'springs' }:initial_stress{ on = 'all', stress "
                      "= {1e5, 0, 0, 0, 0, "
                      "0} }"),
             Contains("the springs of a mesh"));
}

// To 1e-5: the faces are taken as the load strains them, by 1.7e-6.
TEST_CASE("a flow pushes with its pressure on the area that faces it", "[lua]") {
  const std::string velocity = GENERATE(as<std::string>{}, "10", "function(t) return 10 end");
  CHECK(
      error_of(
          held + "model:flow{ direction = {2, 0, 0}, velocity = " + velocity +
          ", water_density = 1000 }\n"
          "assert(model:relax{ residual = 1e-8, breaking = false }.converged)\n"
          "local r = model:reaction('z-')\nclose(r[1], -50000, 1e-5)\nclose(r[3], 0, 1e-1)\n"
          "model:clear_loads()\nmodel:flow{ direction = {-1, 0, -1}, velocity = 10, water_density = 1000 }\n"
          "assert(model:relax{ residual = 1e-8, breaking = false }.converged)\n"
          "close(model:reaction('z-')[1], 50000, 1e-5)\nclose(model:reaction('z-')[3], 50000, 1e-5)") == "");
}

TEST_CASE("a flow over two bodies goes on over the one that is left", "[lua]") {
  const std::string pair =
      meshes_head +
      "local beside = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2}, origin = {0, 3, 0} }\n"
      "local model = cdem.model{ bodies = { { name = 'a', shape = cube, material = concrete },\n"
      "  { name = 'b', shape = beside, material = concrete } } }\nmodel:fix{ on = 'z-' }\n";
  CHECK(error_of(pair + "model:flow{ on = {'a', 'b'}, drag = 1, water = cdem.water.uniform{ velocity = {10, "
                        "0, 0}, density = 1000 } }\n"
                        "model:remove{ on = 'a' }\nassert(model:relax{ residual = 1e-8 }.converged)\n"
                        "close(model:reaction('z-')[1], -50000, 1e-5)") == "");
  CHECK_THAT(error_of(pair + "model:flow{ on = {'a', cdem.select.box{ min = {8, 8, 8}, max = {9, 9, 9} }}, "
                             "water = cdem.water.uniform{ velocity = {10, 0, 0} } }"),
             Contains("a place that holds outer faces"));
}

TEST_CASE("pressure and velocity of a flow turn into each other", "[lua]") {
  CHECK(error_of(meshes_head + "close(cdem.flow_pressure(10), 51250)\n"
                               "close(cdem.flow_velocity(51250), 10)\n"
                               "close(cdem.flow_velocity(50000, 1000), 10)") == "");
  CHECK_THAT(error_of(meshes_head + "cdem.flow_pressure(-1)"), Contains("velocity = -1: must be >= 0"));
  CHECK_THAT(error_of(meshes_head + "cdem.flow_velocity(-1)"), Contains("pressure = -1: must be >= 0"));
}

TEST_CASE("a flow that cannot be is refused", "[lua]") {
  const auto refused = [](const std::string& flow) { return error_of(held + "model:flow{ " + flow + " }"); };
  CHECK_THAT(refused("direction = {0, 0, 0}, velocity = 1"),
             Contains("direction") && Contains("longer than zero"));
  CHECK_THAT(refused("direction = {1, 0, 0}, velocity = -1"), Contains("velocity = -1: must be >= 0"));
  CHECK_THAT(refused("direction = {1, 0, 0}"), Contains("velocity: give it, or water"));
  CHECK_THAT(refused("direction = {1, 0, 0}, velocity = 1, water_density = 0"),
             Contains("water_density = 0"));
  CHECK_THAT(refused("direction = {1, 0, 0}, velocity = function() return -2 end"),
             Contains("velocity(0)") && Contains("-2: must be a finite number >= 0 m/s"));
  CHECK_THAT(refused("direction = {1, 0, 0}, velocity = function() end"),
             Contains("nothing: must be a finite"));
  CHECK_THAT(refused("direction = {1, 0, 0}, velocity = function() return 0 / 0 end"),
             Contains("finite number"));
  CHECK_THAT(error_of(held +
                      "model:flow{ direction = {1, 0, 0}, velocity = function(t) return 1 - 1e6 * t end }\n"
                      "model:run{ steps = 1000 }"),
             Contains("must be a finite number >= 0 m/s"));
  CHECK_THAT(refused("direction = {1, 0, 0}, velocity = 1, on = 'x+'"),
             Contains("direction = (1, 0, 0): must be a direction that meets an outer face") &&
                 Contains("x+"));
  CHECK(refused("direction = {1, 0, 0}, velocity = 1, on = 'x-'") == "");
}

TEST_CASE("the search for the critical flow tells what broke, where and when", "[lua]") {
  CHECK(error_of(meshes_head +
                 "local column = cdem.box_mesh{ size = {0.3, 0.3, 0.75}, divisions = {2, 2, 5} }\n"
                 "local model = model_of{ shape = column, joint = bond }\nmodel:fix{ on = 'z-' }\n"
                 "local r = model:critical_flow{ direction = {1, 0, 0}, held = 'z-', mode = 'ramp', "
                 "pressure_rate = 2e7 }\n"
                 "assert(r.reason == 'fragment' or r.reason == 'compliance', r.reason)\n"
                 "close(r.pressure, cdem.flow_pressure(r.velocity))\n"
                 "assert(r.part == 'root' and r.height_fraction < 1 / 3 and r.place_fraction[3] == "
                 "r.height_fraction)\n"
                 "assert(r.broken_area > 0 and r.broken_tension > 0 and #r.curve > 2 and r.period > 0)\n"
                 "close(r.curve[#r.curve].velocity, r.velocity)\nassert(#r.fragments == #model:fragments())\n"
                 "assert(#model:breaks() == r.broken_tension + r.broken_shear)") == "");
}

TEST_CASE("a search that reaches max_velocity warns and says limit", "[lua]") {
  Script script(held +
                "local r = model:critical_flow{ direction = {1, 0, 0}, max_velocity = 2, pressure_rate = "
                "1e6 }\nassert(r.reason == 'limit' and r.place == nil and r.part == nil)");
  script.run();
  const auto& lines = script.listener->lines;
  CHECK(std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
          return line.find("warning: critical_flow: nothing broke off up to max_velocity = 2 m/s") !=
                 std::string::npos;
        }) == 1);
}

TEST_CASE("a search that cannot be is refused", "[lua]") {
  const auto refused = [](const std::string& more) {
    return error_of(held + "model:critical_flow{ direction = {1, 0, 0}, " + more + " }");
  };
  CHECK_THAT(error_of(meshes_head + "model_of{ joint = bond }:critical_flow{ direction = {1, 0, 0} }"),
             Contains("critical_flow: nothing is held"));
  CHECK_THAT(error_of(held + "model:critical_flow{}"), Contains("direction: missing"));
  CHECK_THAT(refused("on = 'x+'"), Contains("no outer face of the place looks towards the flow"));
  CHECK_THAT(refused("mode = 'rampe'"), Contains("mode = \"rampe\": must be one of \"hold\", \"ramp\""));
  CHECK_THAT(refused("held = 'z'"), Contains("held = \"z\""));
  CHECK_THAT(refused("pressure_rate = 0"), Contains("pressure_rate = 0: must be > 0"));
  CHECK_THAT(refused("hold_periods = 0"), Contains("hold_periods = 0: must be > 0"));
  CHECK_THAT(refused("fragment_fraction = 1"), Contains("fragment_fraction = 1"));
  CHECK_THAT(refused("fragment_fraction = 0"), Contains("fragment_fraction = 0"));
  CHECK_THAT(refused("compliance_ratio = 1"), Contains("compliance_ratio = 1: must be > 1"));
  CHECK_THAT(refused("max_velocity = 1"), Contains("max_velocity = 1: must be > 1"));
  CHECK_THAT(refused("safety = 1.5"), Contains("safety = 1.5"));
  CHECK_THAT(refused("local_damping = 1"), Contains("local_damping = 1"));
  CHECK_THAT(refused("velocity = 3"), Contains("velocity"));
}

TEST_CASE("cell data of a .vtk are the regions of its mesh, and a joint without faces is told", "[lua]") {
  const std::string
      meshes_head = "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
                    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\nCELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\n"
                    "CELL_TYPES 3\n5\n10\n10\n",
      material = "SCALARS material int 1\nLOOKUP_TABLE default\n9\n4\n7\n",
      age = "SCALARS age int 1\nLOOKUP_TABLE default\n0\n1\n2\n",
      body =
          "local cdem = require 'cdem'\n"
          "local mesh = cdem.read_mesh{ file = 'a.vtk' MORE }\nprint(mesh.regions)\n"
          "cdem.model{ bodies = { { shape = mesh, bonds = 'springs', bonded_faces = 'regions', "
          "material = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2000 },\n"
          "  joint = cdem.mohr_coulomb{ cohesion = 1e6, tensile_strength = 1e6, friction_angle = 30 } } } }";
  const auto said = [&](const std::string& data, const std::string& more) {
    std::string text = body;
    Script script(text.replace(text.find("MORE"), 4, more));
    script.write("a.vtk", meshes_head + data);
    return script.printed();
  };
  CHECK_THAT(said("CELL_DATA 3\n" + material, ""), Contains("2 regions by \"material\": 4, 7"));
  CHECK_THAT(said("CELL_DATA 3\n" + material + age, ""),
             Contains("\"age\", which regions = NAME takes instead"));
  CHECK_THAT(said("CELL_DATA 3\n" + material + age, ", regions = 'age'"),
             Contains("2 regions by \"age\": 1, 2"));
  CHECK_THAT(said("", ""), Contains("the mesh has one region, so the joint holds no face"));
}
