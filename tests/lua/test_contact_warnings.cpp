// What a script is warned of where bodies meet, or never do.
#include "tests/lua/stopped_script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// A rigid ground of 2 x 2 m, and cubes of 0.4 m that stand a millimetre above it.
std::string on_ground(const std::string& cubes, const std::string& contacts) {
  return "local cdem = require 'cdem'\n"
         "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }\n"
         "local rough = cdem.coulomb{ friction_angle = 40 }\n"
         "local bodies = { { shape = cdem.box{ size = {2, 2, 0.5}, origin = {0, 0, -0.5} }, material = rock, "
         "name = 'ground', element = 'rigid' } }\n"
         "for name, x in pairs{ " +
         cubes +
         " } do bodies[#bodies + 1] = { shape = cdem.box{ size = {0.4, 0.4, 0.4}, origin = {x, 0.8, 0.001} "
         "}, "
         "material = rock, name = name } end\n"
         "local model = cdem.model{ bodies = bodies, contacts = { " +
         contacts +
         " } }\n"
         "model:fix{ on = 'ground' }\n"
         "model:gravity{ vector = {0, 0, -9.81} }\n";
}

} // namespace

TEST_CASE("a contact that acted on nothing is told of when the run ends", "[lua]") {
  const auto told = [](const std::string& stages) {
    return those_with(
        warnings_of(on_ground("left = 0.2, right = 1.4",
                              "{'left', 'right', rough}, {'left', 'ground', rough}, default = rough") +
                    stages),
        "the law acted on nothing");
  };
  CHECK(told("").empty()); // nothing was solved
  const auto warnings = told("model:settle{}");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0],
             Contains("contact of \"left\" and \"right\": they had no interface and never touched"));
}

TEST_CASE("a contact that closes once has acted", "[lua]") {
  CHECK(those_with(
            warnings_of(on_ground("left = 0.2, right = 0.61", "{'left', 'right', rough}, default = rough") +
                        "model:initial_velocity{ on = 'left', velocity = {0.5, 0, 0} }\n"
                        "model:run{ duration = 0.03, safety = 0.3 }"),
            "the law acted on nothing")
            .empty());
}

TEST_CASE("blocks of small strain that share no face are told of at once", "[lua]") {
  const auto warnings = warnings_of(
      "local cdem = require 'cdem'\n"
      "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }\n"
      "local function box(x, name) return { shape = cdem.box{ size = {1, 1, 1}, origin = {x, 0, 0} }, "
      "material = rock, name = name, element = 'small_strain' } end\n"
      "cdem.model{ bodies = { box(0, 'a'), box(1.1, 'b') }, "
      "contacts = { {'a', 'b', cdem.coulomb{ friction_angle = 30 }} } }");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("case.lua:4: warning: contact of \"a\" and \"b\": they share no face"));
}

TEST_CASE("a unit that falls off its ground is told of once, and the others come to rest", "[lua]") {
  Script script(on_ground("stays = 0.8, falls = 1.9", "default = rough") +
                "assert(model:settle{ max_time = 5 }.converged)\n"
                "local z = model:min('displacement.z', 'falls')\n"
                "assert(model:run{ duration = 0.01 }.steps > 0)\n"
                "assert(model:min('displacement.z', 'falls') == z)\n" // held there
                "cdem.report{ { name = 'stays', value = model:min('displacement.z', 'stays') } }");
  script.run();
  const auto told = those_with(script.listener->lines, "has left the model");
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Contains("warning: stage 1 (settle: rigid fall): \"falls\" has left the model at 1.") &&
                          Contains("it is held there and the rest goes on"));
  CHECK_THAT(script.read("report.json"), Contains("case.lua:9: warning: stage 1 (settle: rigid fall)"));
}

TEST_CASE(
    "a sole that vibrates and slides below its friction is told of, and one that slides by its law is not",
    "[lua][contact]") {
  const auto told = [](double restitution, int friction, int angle, const std::string& begin) {
    return those_with(warnings_of("local cdem = require 'cdem'\n"
                                  "local e, friction, angle = " +
                                  std::to_string(restitution) + ", " + std::to_string(friction) + ", " +
                                  std::to_string(angle) + R"(
local stone = cdem.elastic{ youngs_modulus = 3e10, poissons_ratio = 0.25, density = 2400 }
local m = cdem.model{
  bodies = { { name = "floor", material = stone, element = "rigid",
               shape = cdem.box_mesh{ size = {4, 2, 0.5}, divisions = {4, 2, 1}, origin = {-1, -0.5, -0.5} } },
             { name = "plate", material = stone,
               shape = cdem.box_mesh{ size = {1, 1, 0.25}, divisions = {2, 2, 1}, origin = {0.13, 0.05, 0} } } },
  contacts = { { "floor", "plate", cdem.coulomb{ friction_angle = friction, restitution = e } } } }
m:fix{ on = "floor" }
m:gravity{ vector = {9.81 * math.sin(math.rad(angle)), 0, -9.81 * math.cos(math.rad(angle))} }
)" + begin + R"(
m:run{ duration = 0.1 }
)"),
                      "of the work that its law asks for");
  };
  const std::vector<std::string> vibrates = told(0.3, 60, 64, ""); // its weight at once
  REQUIRE(vibrates.size() == 1);
  CHECK_THAT(vibrates[0],
             Contains("contact of \"floor\" and \"plate\": they slide, and friction has done 0."));
  const std::string relaxed = "m:relax{ residual = 1e-6 }";
  CHECK(told(1, 50, 53, "").size() == 1); // it bounces
  CHECK(told(0.5, 30, 33, relaxed).empty());
  CHECK(told(1, 30, 33, relaxed).empty());
  CHECK(told(1, 30, 25, relaxed).empty()); // it stands
}

TEST_CASE("a block that slides face on face below its friction is told of, and a damped one is not",
          "[lua][contact]") {
  const auto told = [](const std::string& element, const std::string& material, double height) {
    return those_with(warnings_of("local cdem = require 'cdem'\n"
                                  "local element, height = '" +
                                  element + "', " + std::to_string(height) + R"(
local g, angle = 9.81, math.rad(43)
local stone = cdem.elastic{ youngs_modulus = 20e9, poissons_ratio = 0.2, density = 2400)" +
                                  material + R"( }
local m = cdem.model{
  bodies = { { name = "floor", material = stone, element = element,
               shape = cdem.box{ size = {4, 2, 1}, origin = {-1.5, -0.5, -1} } },
             { name = "block", material = stone, element = element, shape = cdem.box{ size = {1, 1, height} } } },
  contacts = { { "floor", "block", cdem.coulomb{ friction_angle = 40 } } } }
m:fix{ on = "floor" }
m:gravity{ vector = {g * math.sin(angle), 0, -g * math.cos(angle)} }
m:run{ duration = 0.1 }
)"),
                      "of the work that its law asks for");
  };
  for (const char* element : {"finite_volume", "small_strain"}) {
    const std::vector<std::string> vibrates = told(element, "", 0.25);
    REQUIRE(vibrates.size() == 1);
    CHECK_THAT(vibrates[0],
               Contains("contact of \"floor\" and \"block\": they slide, and friction has done 0.") &&
                   Contains("the materials a stiffness_damping of 0.05 h"));
  }
  CHECK(told("finite_volume", ", stiffness_damping = 3e-5", 0.25).empty());
  CHECK(told("rigid", "", 0.25).empty());
}

namespace {

// Two irregular tetrahedra of 0.16 m meet at 4 m/s; "part": the largest part of a volume in which they overlap, %.
Script meeting_tetrahedra(const std::string& element, const std::string& stiffness) {
  return Script("local cdem = require 'cdem'\nlocal element, k = '" + element + "', " + stiffness + R"(
local stone = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local law = cdem.coulomb{ friction_angle = 35, restitution = 0.3, normal_stiffness = k, shear_stiffness = k }
local chance = 30 * 7919 + 13
local function random()
  chance = (chance * 1103515245 + 12345) % 2147483648
  return chance / 2147483648
end
for _ = 1, 5 do random() end
local function turned(u, v, angle)
  return u * math.cos(angle) - v * math.sin(angle), u * math.sin(angle) + v * math.cos(angle)
end
local function tetrahedron(x0, y0, z0)
  local a, b, c = random() * 6.28, random() * 6.28, random() * 6.28
  local points = {}
  for i, w in ipairs{ {1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1} } do
    local x, y, z = w[1] * (0.7 + 0.6 * random()), w[2] * (0.7 + 0.6 * random()), w[3] * (0.7 + 0.6 * random())
    x, y = turned(x, y, a)
    y, z = turned(y, z, b)
    x, z = turned(x, z, c)
    points[i] = { x0 + 0.12 * x, y0 + 0.12 * y, z0 + 0.12 * z }
  end
  return cdem.convex_hull{ points = points }
end
local lower = tetrahedron(0, 0, 0)
local upper = tetrahedron(0.1 * (random() - 0.5), 0.1 * (random() - 0.5), 0.5)
local m = cdem.model{ bodies = { { name = "lower", shape = lower, material = stone, element = element },
                                 { name = "upper", shape = upper, material = stone, element = element } },
                      contacts = { default = law } }
m:initial_velocity{ on = "upper", velocity = {0, 0, -4} }
local part = 0
for _ = 1, 30 do
  m:run{ duration = 0.00625, safety = 0.2 }
  part = math.max(part, m:overlap().volume / math.min(lower:volume(), upper:volume()))
end
print("part " .. 100 * part)
)");
}

double number_after(Script& script, const std::string& word) {
  const std::vector<std::string> lines = those_with(script.listener->lines, word);
  REQUIRE(lines.size() == 1);
  return std::stod(lines[0].substr(lines[0].find(word) + word.size()));
}

} // namespace

TEST_CASE("bodies that lie in each other without a contact are told of, and how far", "[lua][contact]") {
  const auto element = GENERATE(as<std::string>{}, "rigid", "finite_volume");
  CAPTURE(element);
  Script soft = meeting_tetrahedra(element, "1e8");
  soft.run();
  const std::vector<std::string> told = those_with(soft.listener->lines, "without a contact between them");
  REQUIRE(!told.empty());
  const std::string words = "they overlap by ";
  const auto told_part = [&](const std::string& line) {
    return std::stod(line.substr(line.find(words) + words.size()));
  };
  const double most = number_after(soft, "part ");
  CHECK(told_part(told.front()) > 1);
  CHECK(told_part(told.back()) < 1.006 * most);
  CHECK(told_part(told.back()) > most / 1.6);
  Script stiff = meeting_tetrahedra(element, "1e10");
  stiff.run();
  CHECK(number_after(stiff, "part ") < 0.1);
  CHECK(those_with(stiff.listener->lines, "without a contact between them").empty());
}

TEST_CASE("a block that is pulled slowly by some elastic deflections of its joint is not told of",
          "[lua][contact]") {
  const std::string shape = GENERATE(as<std::string>{}, "cdem.box{ size = {1, 1, 0.5} }",
                                     "cdem.grid{ size = {1, 1, 0.5}, divisions = {2, 2, 2} }"),
                    element = GENERATE(as<std::string>{}, "finite_volume", "small_strain");
  CAPTURE(shape, element);
  const std::vector<std::string> told =
      warnings_of("local cdem = require 'cdem'\nlocal shape, element = " + shape + ", '" + element + R"('
local stone = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2400 }
local strong = cdem.mohr_coulomb{ cohesion = 1e12, friction_angle = 0, tensile_strength = 1e12 }
local floor = cdem.box{ size = {4, 2, 0.5}, origin = {-1, -0.5, -0.5} }
local m = cdem.model{ bodies = { { name = "floor", material = stone, element = element, shape = floor },
                                 { name = "block", material = stone, element = element, shape = shape,
                                   joint = strong, bonds = "springs" } },
                      contacts = { { "floor", "block", cdem.coulomb{ friction_angle = 30 } } } }
m:fix{ on = "floor" }
m:traction{ on = cdem.select.box{ min = {-0.1, -0.1, 0.499}, max = {1.1, 1.1, 0.501} }, pressure = 1e6 }
m:relax{ residual = 1e-6 }
local begin, side = m.time, cdem.select.box{ min = {0.999, -0.1, 0.001}, max = {1.001, 1.1, 0.6} }
m:fix{ on = side, axes = "x", velocity = {0.02, 0, 0},
       amplitude = function(t) return math.min(1, (t - begin) / 0.005) end }
for _ = 1, 4 do m:run{ duration = 0.02 } end
)");
  CHECK(those_with(told, "they slide").empty());
}

TEST_CASE("a block that sticks to a ground which shakes is not told of as one that slides",
          "[lua][contact]") {
  const std::vector<std::string> told = warnings_of(R"(
local cdem = require "cdem"
local stone = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local floor = cdem.box_mesh{ size = {1.5, 1.5, 0.1}, divisions = {2, 2, 1}, origin = {-0.2, -0.2, -0.1} }
local block = cdem.box_mesh{ size = {1, 1, 0.25}, divisions = {2, 2, 1}, origin = {0.03, 0.02, 0} }
local m = cdem.model{ bodies = { { name = "floor", material = stone, element = "rigid", shape = floor },
                                 { name = "block", material = stone, shape = block } },
                      contacts = { { "floor", "block", cdem.coulomb{ friction_angle = 40, thickness = 2 } } } }
m:fix{ on = "floor" }
m:gravity{ vector = {0, 0, -9.81} }
m:relax{}
local begin, omega = m.time, 2 * math.pi * 30
m:fix{ on = "floor", velocity = {0.3 * 9.81 / omega, 0, 0},
       amplitude = function(t) return math.sin(omega * (t - begin)) * math.min(1, 10 * (t - begin)) end }
m:run{ duration = 0.5 }
)");
  CHECK(those_with(told, "they slide").empty());
}

TEST_CASE("a body that is thrown, bounces and rolls is not told of as one that slides", "[lua][contact]") {
  const auto told =
      [](const std::string& restitution, const std::string& velocity) {
        return those_with(warnings_of(R"(
local cdem = require "cdem"
local stone = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local floor = cdem.box_mesh{ size = {8, 4, 0.5}, divisions = {4, 2, 1}, origin = {-1, -2, -0.5} }
local cube = cdem.box_mesh{ size = {0.4, 0.4, 0.4}, divisions = {1, 1, 1}, origin = {0, 0, 0.1} }
local m = cdem.model{ bodies = { { name = "floor", material = stone, element = "rigid", shape = floor },
                                 { name = "cube", material = stone, shape = cube } },
                      contacts = { { "floor", "cube", cdem.coulomb{ friction_angle = 35,
                                                                   restitution = )" +
                                      restitution + R"( } } } }
m:fix{ on = "floor" }
m:gravity{ vector = {0, 0, -9.81} }
m:initial_velocity{ on = "cube", )" + velocity +
                                      R"( }
m:run{ duration = 0.8 }
)"),
                          "they slide");
      };
  CHECK(told("0.5", "velocity = {2, 0, 0}").empty());
  CHECK(told("0.3", "velocity = {2, 0, 0}, angular_velocity = {0, 8, 0}, about = {0.2, 0.2, 0.3}").empty());
}

TEST_CASE("a resumed script tells of the same sliding", "[lua][contact]") {
  const std::string slides = R"(
local cdem = require "cdem"
local stone = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local m = cdem.model{ bodies = {
  { name = "floor", material = stone, shape = cdem.box{ size = {4, 2, 1}, origin = {-1.5, -0.5, -1} } },
  { name = "block", material = stone, shape = cdem.box{ size = {1, 1, 0.25} } } },
  contacts = { { "floor", "block", cdem.coulomb{ friction_angle = 40 } } } }
m:fix{ on = "floor" }
m:gravity{ vector = {9.81 * math.sin(math.rad(43)), 0, -9.81 * math.cos(math.rad(43))} }
m:run{ duration = 0.05 }
m:run{ duration = 0.05 }
)";
  const auto told = [](const StoppedScript& script) { // without the name of its folder
    std::vector<std::string> lines = those_with(script.listener->lines, "of the work that its law asks for");
    for (std::string& line : lines)
      line.erase(0, line.find("warning: "));
    return lines;
  };
  StoppedScript whole(slides), broken(slides);
  const int looks = whole.count_looks();
  const std::vector<std::string> once = told(whole);
  REQUIRE(once.size() == 1);
  REQUIRE_FALSE(broken.ends_before(looks / 3)); // before anything is told
  REQUIRE(told(broken).empty());
  broken.go_on_from_newest();
  broken.run();
  CHECK(told(broken) == once);
}
