// Bodies of every kind as scripts make them: meshes in parts, meshes as blocks, zoned blocks, blocks as meshes, spin.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string bodies_head =
    opening +
    "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2500 }\n"
    "local bond = cdem.mohr_coulomb{ cohesion = 5e6, friction_angle = 35, tensile_strength = 2e6 }\n"
    "local cells = cdem.voronoi{ size = {1, 1, 1}, count = 6 }\n"
    // Two cubes of 1 m, the second half a metre beside the first.
    "local pair = cdem.solid.union{ solids = { cdem.solid.box{ size = {1, 1, 1} },\n"
    "  cdem.solid.box{ size = {1, 1, 1}, origin = {1.5, 0, 0} } } }:mesh{ size = 0.5 }\n";

} // namespace

TEST_CASE("a mesh in two parts says so and is two units that move by themselves", "[lua]") {
  const std::string text = bodies_head +
                           "assert(pair.parts == 2 and tostring(pair):find('in 2 parts'))\n"
                           "local model = cdem.model{ bodies = { { shape = pair, material = rock, "
                           "element = 'rigid', name = 'pair' } },\n"
                           "  contacts = { default = cdem.coulomb{ friction_angle = 30 } } }\n"
                           "assert(model:counts().blocks == 2)\n";
  Script script(text);
  script.settings.check_only = true;
  CHECK(script.error() == "");
  CHECK_THAT(script.engine->model_summary(), Contains("mesh of \"pair\" in 2 parts, each moves by itself"));
  CHECK_THAT(printed_by(text), Contains("mesh of \"pair\" in 2 parts: each moves by itself"));
  CHECK_THAT(error_of(text + "model:pile{ body = 'pair' }"), Contains("a mesh in several parts"));
  CHECK(error_of(text +
                 "local function unit(i) return cdem.select.units{ body = 'pair', numbers = {i} } end\n"
                 "model:initial_velocity{ on = unit(1), velocity = {0, 0, 1} }\n"
                 "model:run{ duration = 0.1, time_step = 1e-3 }\n"
                 "close(model:mean('displacement.z', unit(1)), 0.1, 1e-6)\n"
                 "close(model:mean('displacement.z', unit(2)), 0, 1e-12)") == "");
}

TEST_CASE("one part of a mesh turns rigid and back while the other deforms", "[lua]") {
  CHECK(
      error_of(
          bodies_head +
          "local model = cdem.model{ bodies = { { shape = pair, material = rock, name = 'pair' } } }\n"
          "local first = cdem.select.units{ body = 'pair', numbers = {1} }\n"
          "assert(model:make_rigid{ on = first } == 1)\n"
          "model:initial_velocity{ angular_velocity = {0, 0, 1}, on = first }\n"
          "model:run{ duration = 0.01 }\n"
          "assert(model:max('velocity.magnitude', first) > 0.5)\n"
          "assert(model:max('velocity.magnitude', cdem.select.units{ body = 'pair', numbers = {2} }) == 0)\n"
          "assert(model:make_deformable{ on = 'all' } == 1)\nmodel:run{ steps = 10 }\n"
          "assert(model:energy().balance_error < 1e-3)") == "");
}

TEST_CASE("a pile of units in loose parts falls part by part", "[lua]") {
  CHECK(
      error_of(
          bodies_head +
          "local floor = cdem.box_mesh{ size = {12, 12, 1}, divisions = {2, 2, 1} }\n"
          "local pile = cdem.drop{ unit = pair, count = 2, onto = floor }\nassert(#pile == 2)\n"
          "local model = cdem.model{ bodies = { { shape = floor, material = rock, element = 'rigid', name = "
          "'floor' },\n  { shape = pile, material = rock, element = 'rigid', name = 'pile' } },\n"
          "  contacts = { default = cdem.coulomb{ friction_angle = 30 } } }\n"
          "assert(model:counts().blocks == 5)\nmodel:fix{ on = 'floor' }\n"
          "model:gravity{ vector = {0, 0, -9.81} }\nmodel:run{ duration = 2, local_damping = 0.3 }\n"
          "assert(model:min('displacement.z', 'pile') < -0.1)\n"
          "assert(model:energy().balance_error < 0.01)") == "");
}

TEST_CASE("the tetrahedra of a mesh become blocks that are bonded, fall and come apart", "[lua]") {
  CHECK(
      error_of(
          bodies_head +
          "local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }\n"
          "local shape = cdem.blocks{ mesh = mesh }\n"
          "assert(#shape == 48)\nclose(shape:volume(), 1)\n"
          "local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = bond } } }\n"
          "local c = model:counts()\nassert(c.blocks == 48 and c.interfaces == 72 and c.intact == c.bonds)\n"
          "model:fix{ on = 'z-' }\nmodel:traction{ on = 'z+', stress = {0, 0, -1e5} }\n"
          "local relaxed = model:relax{ residual = 1e-6, breaking = false }\nassert(relaxed.converged)\n"
          "assert(model:mean('displacement.z', 'z+') < 0)\n"
          "assert(#model:refine{ shear_threshold = 1e9, tension_threshold = 1e9 } > 0)\n"
          "assert(model:counts().blocks > 48)") == "");
}

TEST_CASE("zone_size gives blocks a finer mesh, and is refused where it means nothing", "[lua]") {
  CHECK(error_of(bodies_head +
                 "local function tets(zone_size)\n  return cdem.model{ bodies = { { shape = cells, "
                 "material = rock, joint = bond, zone_size = zone_size } } }:counts()\nend\n"
                 "local star, zoned = tets(nil), tets(0.2)\n"
                 "assert(star.blocks == 6 and zoned.blocks == 6 and zoned.tets > 2 * star.tets)\n"
                 "assert(zoned.interfaces == star.interfaces and zoned.bonds > star.bonds)") == "");
  const auto refused = [](const std::string& body) {
    return error_of(bodies_head + "cdem.model{ bodies = { { material = rock, joint = bond, " + body +
                    " } } }");
  };
  CHECK_THAT(refused("shape = pair, zone_size = 0.2"), Contains("bodies[1].zone_size: only for an assembly"));
  CHECK_THAT(refused("shape = cells, zone_size = 0"), Contains("zone_size = 0: must be > 0"));
  CHECK_THAT(refused("shape = cells, zone_size = 0.2, element = 'small_strain'"), Contains("zone_size"));
}

TEST_CASE("an assembly becomes one mesh whose regions are its blocks", "[lua]") {
  CHECK(error_of(
            bodies_head +
            "local solid = cells:solid()\nassert(#solid == 6)\n"
            "local mesh = solid:mesh{ size = 0.4 }\nassert(mesh.parts == 1)\nclose(mesh:volume(), 1, 1e-6)\n"
            "local blocks, regions = cells:blocks(), solid:regions()\n"
            "for i = 1, 6 do close(regions[i], blocks[i].volume, 1e-6) end\n"
            "local function model(faces)\n  return cdem.model{ bodies = { { shape = mesh, material = rock, "
            "joint = bond, bonds = 'springs', bonded_faces = faces } } }:counts()\nend\n"
            "local along, all = model('regions'), model('all')\n"
            "assert(along.bonds > 0 and all.bonds > 2 * along.bonds and along.tets == all.tets)") == "");
  // Two blocks that do not touch: two parts, each of which moves by itself.
  CHECK(error_of(bodies_head + "local two = cdem.merge{ shapes = { cdem.box{ size = {1, 1, 1} },\n"
                               "  cdem.box{ size = {1, 1, 1}, origin = {2, 0, 0} } } }\n"
                               "assert(two:solid():mesh{ size = 1 }.parts == 2)") == "");
}

TEST_CASE("bodies start with velocity, spin or both", "[lua]") {
  const std::string model =
      bodies_head +
      "local model = cdem.model{ bodies = { { shape = cells, material = rock, joint = bond } } }\n";
  CHECK(error_of(model +
                 "model:initial_velocity{ velocity = {1, 0, 0}, angular_velocity = {0, 0, 2} }\n"
                 "close(model:mean('velocity.x'), 1, 1e-9)\nclose(model:mean('velocity.y'), 0, 1e-9)\n"
                 "close(model:max('velocity.x'), 2, 1e-9)\n" // v - w y, y from the centroid at 0.5
                 "model:initial_velocity{ angular_velocity = {0, 0, 2}, about = {0, 0, 0} }\n"
                 "close(model:max('velocity.y'), 2, 1e-9)\nclose(model:min('velocity.y'), 0, 1e-9)") == "");
  CHECK_THAT(error_of(model + "model:initial_velocity{}"),
             Contains("give velocity (m/s), angular_velocity (rad/s)"));
  CHECK_THAT(error_of(model + "model:initial_velocity{ velocity = {1, 0, 0}, about = {0, 0, 0} }"),
             Contains("about: goes with angular_velocity"));
}
