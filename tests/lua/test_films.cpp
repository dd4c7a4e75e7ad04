// A film of a model that is solved: its frames, that it changes nothing, and that it goes on when a run does.
#include "libcdem/step/errors.hpp"
#include "tests/lua/script.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// A cube that falls on another, which is held.
const std::string cubes =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }\n"
    "local function cube(z) return cdem.solid.box{ size = {1, 1, 1}, origin = {0, 0, z} }:mesh{ size = 1 } "
    "end\n"
    "local model = cdem.model{ bodies = { { shape = cube(0), material = rock, name = 'floor' },\n"
    "  { shape = cube(1.001), material = rock, name = 'cube' } },\n"
    "  contacts = { default = cdem.coulomb{ friction_angle = 40 } } }\n"
    "model:fix{ on = 'z-' }\nmodel:gravity{ vector = {0, 0, -9.81} }\n";
const std::string run = "model:run{ duration = 0.02, local_damping = 0.2 }\n";
const std::string hash = "print(model.state_hash, #model:history().step)\n";

std::string film(const std::string& how) {
  return "model:film{ file = 'fall.ogv', size = {160, 120}, " + how + " }\n";
}

std::vector<std::string> frames_of(const Script& script) {
  std::vector<std::string> names;
  if (script.wrote("fall"))
    for (const auto& entry : fs::directory_iterator(script.settings.output / "fall"))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

TEST_CASE("a film has a frame where it begins and one at each interval, and changes no bit", "[film]") {
  Script without(cubes + run + hash), by_time(cubes + film("every = 0.005") + run + hash),
      by_steps(cubes + film("steps = 20") + "model:run{ steps = 50 }\nmodel:relax{ max_steps = 45 }\n");
  without.run();
  by_time.run();
  by_steps.run();
  CHECK(frames_of(by_time).size() == 5);
  CHECK(by_time.read("fall.ogv").rfind("OggS", 0) == 0);
  CHECK(by_time.listener->lines.back() == without.listener->lines.back());
  CHECK(by_time.read("history.csv") == without.read("history.csv"));
  CHECK(frames_of(by_steps) == std::vector<std::string>{"000000000.png", "000000020.png", "000000040.png",
                                                        "000000070.png", "000000090.png"});
  CHECK(by_steps.read("fall/000000090.png") != by_steps.read("fall/000000000.png"));
}

TEST_CASE("a film of a run that was stopped is there, and goes on as if the run had not been", "[film]") {
  const std::string text =
      cubes + film("every = 0.002") + run + "model:relax{ max_steps = 100 }\n" + run + hash;
  Script whole(text), broken(text);
  whole.run();
  broken.listener->stop = [&] { return frames_of(broken).size() >= 5; };
  CHECK_THROWS_AS(broken.run(), cdem::Interrupted);
  const std::vector<std::string> before = frames_of(broken), all = frames_of(whole);
  CHECK(before.size() < all.size());
  CHECK(broken.wrote("fall.ogv"));
  broken.listener->stop = nullptr;
  broken.settings.resume = newest_checkpoint(broken.settings.output).file;
  broken.run();
  CHECK(broken.listener->lines.back() == whole.listener->lines.back());
  CHECK(frames_of(broken) == all);
  for (const std::string& name : all)
    CHECK(broken.read("fall/" + name) == whole.read("fall/" + name));
  CHECK(broken.read("fall.ogv").size() == whole.read("fall.ogv").size());
}

TEST_CASE("a film of a script that fails is written, and a check takes none", "[film]") {
  Script failing(cubes + film("every = 0.005") + run + "error('no more')");
  CHECK_THAT(failing.error(), Contains("no more"));
  CHECK(failing.wrote("fall.ogv"));
  Script checked(cubes + film("every = 0.005, colour = 'velocity.z', range = {-1, 1}") + run);
  checked.settings.check_only = true;
  checked.run();
  CHECK_FALSE(checked.wrote("fall.ogv"));
  CHECK(frames_of(checked).empty());
}

TEST_CASE("a film that cannot be taken is refused where it is asked for", "[film]") {
  const auto error = [](const std::string& how) { return Script(cubes + film(how)).error(); };
  CHECK_THAT(error("title = 'fall'"), Contains("every, steps: give one of them"));
  CHECK_THAT(error("every = 0.1, steps = 2"), Contains("every, steps: give one of them"));
  CHECK_THAT(error("every = 0.1, colour = 'stres.xx'"), Contains("stress.xx"));
  CHECK_THAT(error("every = 0.1 }\nmodel:film{ file = 'fall.ogv', every = 0.2"),
             Contains("another name than that of a film that is taken already"));
  CHECK_THAT(Script(cubes + "model:film{ file = 'fall.avi', every = 1 }").error(), Contains(".ogv or .mp4"));
  CHECK_THAT(Script(cubes + "model:film{ file = 'fall.ogv', every = 1, size = {160, 0} }").error(),
             Contains("a width and a height"));
}
