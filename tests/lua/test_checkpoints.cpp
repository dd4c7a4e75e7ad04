// A script that was stopped goes on as if it had not been: its own variables, what it writes and what it solves.
#include "libcdem/checkpoint/file.hpp"
#include "libcdem/state/contact.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/core/random.hpp"
#include "lua/binding/replay/journal.hpp"
#include "tests/lua/stopped_script.hpp"

#include <catch2/catch.hpp>
#include <cstring>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// A plate that breaks: callbacks with variables of the script, refused calls, cutting, files that are added to, and a
// file of its own that it requires.
const char* const plate = R"(
local cdem = require "cdem"
local helper = require "helper"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 6e5, friction_angle = 30, tensile_strength = 2e5 }
local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 0.25}, divisions = {4, 4, 1} },
  material = rock, joint = joint, name = "plate" } } }
print "begins"
local seen = {}
local function note(text) seen[#seen + 1] = text end
local function add(text)
  local file = io.open("lines.txt", "a")
  file:write(text, "\n")
  file:close()
end
model:select{ name = "top", on = "y+" }
model:fix{ on = "y-" }
model:traction{ on = "top", stress = {2e5, 2.5e5, 0}, amplitude = function(t) return helper.factor + 0 * model.time end }
note(tostring(select(2, pcall(model.fix, model, { on = function() return false end }))))
note(tostring(select(2, pcall(model.max, model, "no_such_field"))))
model:after_stage(function(stage)
  note(stage.kind .. " " .. model:max("displacement.magnitude"))
  add("after " .. stage.kind)
  model:save{ file = "stage_" .. stage.number .. ".vtu", series = "all.pvd" }
end)
model.memory.calls = 0
model:relax{ max_steps = 700, every = 50, callback = function()
  model.memory.calls = model.memory.calls + 1
  note(model:max("displacement.y"))
  add(model:counts().intact)
end }
note(#model:refine{ tension_threshold = 1e6, planes = 1 })
model:initial_velocity{ velocity = {0, 0, 0.01} }
local final = model:run{ every = 30, stop = function()
  model.memory.calls = model.memory.calls + 1
  return model.steps >= 1500
end }
model:relax{ max_steps = 300 }
cdem.report{ { name = "hash", value = model.state_hash }, { name = "calls", value = model.memory.calls },
  { name = "seen", value = table.concat(seen, "\n") }, { name = "steps", value = final.steps },
  { name = "rows", value = #model:history().step }, { name = "breaks", value = #model:breaks() },
  { name = "blocks", value = model:counts().blocks }, { name = "random", value = math.random() } }
print "ends"
)";

} // namespace

TEST_CASE("resume: a script that was stopped anywhere ends with the same report, files and state",
          "[checkpoint]") {
  StoppedScript whole(plate);
  whole.run();
  const std::string report = whole.text("report.json");
  REQUIRE(report.find("resume") == std::string::npos);
  for (const int look : {12, 30, 56, 62, 90, 110}) {
    INFO("stopped at look " << look);
    StoppedScript broken(plate);
    REQUIRE_FALSE(broken.ends_before(look));
    broken.go_on_from_newest();
    broken.settings.threads = look % 2 == 0 ? 2 : 1;
    broken.listener->lines.clear();
    broken.run();
    CHECK(broken.text("report.json") == report);
    CHECK(broken.read("lines.txt") == whole.read("lines.txt"));
    CHECK(broken.read("history.csv") == whole.read("history.csv"));
    CHECK(broken.read("all.pvd") == whole.read("all.pvd"));
    for (const std::string& line : broken.listener->lines)
      CHECK(line != "begins"); // said before
    CHECK(broken.listener->lines.back() == "ends");
    CHECK_FALSE(broken.wrote("checkpoint_1.cdem")); // it has ended
    CHECK_FALSE(broken.wrote("checkpoint_2.cdem"));
  }
}

TEST_CASE("resume: a script may be stopped again and again", "[checkpoint]") {
  StoppedScript whole(plate), broken(plate);
  whole.run();
  int rounds = 0;
  for (; !broken.ends_before(30); ++rounds) {
    REQUIRE(rounds < 20);
    broken.go_on_from_newest();
  }
  CHECK(rounds > 2);
  CHECK(broken.text("report.json") == whole.text("report.json"));
}

TEST_CASE("resume: checkpoints that are written all the time change nothing, and the newest is gone on from",
          "[checkpoint]") {
  StoppedScript whole(plate), broken(plate);
  whole.run();
  broken.settings.checkpoint_minutes = 1e-9;
  REQUIRE_FALSE(broken.ends_before(70));
  CHECK(broken.wrote("checkpoint_1.cdem"));
  CHECK(broken.wrote("checkpoint_2.cdem"));
  const CheckpointInfo newest = newest_checkpoint(broken.settings.output);
  CHECK(newest.serial > 10);
  // A damaged newest one leaves the other.
  fs::resize_file(newest.file, fs::file_size(newest.file) / 2);
  CHECK(newest_checkpoint(broken.settings.output).serial == newest.serial - 1);
  broken.go_on_from_newest();
  broken.run();
  CHECK(broken.text("report.json") == whole.text("report.json"));
}

TEST_CASE("resume: a growing crack that was stopped begins its stage again", "[checkpoint]") {
  const std::string text = R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 3e5, friction_angle = 30, tensile_strength = 1e5 }
local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 0.25}, divisions = {4, 4, 1} },
  material = rock, joint = joint, name = "plate" } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {0, 1.1e5, 0} }
local passes = 0
model:relax{ breaking = false, residual = 1e-4 }
local grown = model:grow{ passes = 2, residual = 1e-3, max_steps = 2000, max_rounds = 3,
  callback = function(pass) passes = passes + pass.rounds end }
cdem.report{ { name = "hash", value = model.state_hash }, { name = "state", value = grown.state },
  { name = "passes", value = passes }, { name = "blocks", value = model:counts().blocks } }
)";
  StoppedScript whole(text), broken(text);
  const int looks = whole.count_looks();
  REQUIRE_FALSE(broken.ends_before(looks * 3 / 4));
  broken.go_on_from_newest();
  broken.run();
  CHECK(broken.text("report.json") == whole.text("report.json"));
}

TEST_CASE("resume: a settling whose callback counts goes on in each of its phases, and the search after it",
          "[checkpoint]") {
  const std::string text = R"(
local cdem = require "cdem"
local soft = cdem.elastic{ youngs_modulus = 2e8, poissons_ratio = 0.2, density = 2500 }
local cube = cdem.box_mesh{ size = {0.5, 0.5, 0.5}, divisions = {2, 2, 2} }
local slab = cdem.box_mesh{ size = {2, 2, 0.5}, divisions = {4, 4, 1} }
local model = cdem.model{ bodies = {
  { shape = slab, material = soft, element = "rigid", name = "floor" },
  { shape = cdem.drop{ unit = cube, count = 2, onto = slab, seed = 2, gap = 0.01 }, material = soft, name = "units",
    joint = cdem.mohr_coulomb{ cohesion = 1e5, friction_angle = 30, tensile_strength = 3e4 } } },
  contacts = { { "floor", "units", cdem.coulomb{ friction_angle = 35 } },
               { "units", "units", cdem.coulomb{ friction_angle = 35 } } } }
model:fix{ on = "floor" }
model:gravity{ vector = {0, 0, -9.81} }
local calls, lowest = 0, math.huge
local settled = model:settle{ kinetic_energy_ratio = 1e-3, max_time = 20, every = 60, callback = function()
  calls = calls + 1
  lowest = math.min(lowest, model:min("displacement.z", "units"))
  model:save{ file = "step.vtu", series = "steps.pvd" }
end }
model:fix{ on = "units" }
model:release{ on = cdem.select.units{ body = "units", numbers = {1} } }
model:fix{ on = cdem.select.where(function(_, _, z) return z < 0.85 end) }
local found = model:critical_flow{ direction = {1, 0, 0}, pressure_rate = 1e8, hold_periods = 0.5 }
cdem.report{ { name = "hash", value = model.state_hash }, { name = "calls", value = calls },
  { name = "lowest", value = lowest }, { name = "steps", value = settled.steps }, { name = "broken", value = found.steps },
  { name = "phases", value = #settled.phases }, { name = "velocity", value = found.velocity } }
)";
  StoppedScript whole(text);
  const int looks = whole.count_looks();
  CHECK_THAT(whole.text("report.json"), Contains("\"phases\""));
  for (const double part : {0.3, 0.6, 0.85, 0.97}) {
    INFO("stopped after " << part << " of the looks");
    StoppedScript broken(text);
    REQUIRE_FALSE(broken.ends_before(static_cast<int>(part * looks)));
    broken.go_on_from_newest();
    broken.settings.threads = part < 0.5 ? 2 : 1;
    broken.run();
    CHECK(broken.text("report.json") == whole.text("report.json"));
    CHECK(broken.read("history.csv") == whole.read("history.csv"));
    CHECK(broken.read("steps.pvd") == whole.read("steps.pvd"));
  }
}

TEST_CASE("resume: conditions on named faces hold on after it", "[checkpoint]") {
  const std::string text = R"(
local cdem = require "cdem"
local mesh = cdem.box_mesh{ size = {0.3, 0.3, 0.8}, divisions = {3, 3, 8}, jitter = 0.1 }
mesh:faces{ side = "z-", name = "root" }
mesh:faces{ side = "x-", name = "wet" }
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local model = cdem.model{ bodies = { { shape = mesh, material = rock, name = "unit" } } }
model:fix{ on = cdem.select.faces{ body = "unit", name = "root" } }
model:flow{ on = cdem.select.faces{ name = "wet" }, direction = {1, 0, 0}, velocity = 10 }
model:run{ steps = 1500 }
cdem.report{ { name = "hash", value = model.state_hash },
  { name = "held", value = model:max("displacement.magnitude", cdem.select.faces{ name = "root" }) } }
)";
  StoppedScript whole(text), broken(text);
  whole.run();
  REQUIRE_FALSE(broken.ends_before(50));
  broken.go_on_from_newest();
  broken.run();
  CHECK(broken.text("report.json") == whole.text("report.json"));
}

TEST_CASE("resume: an asked checkpoint holds all up to its line", "[checkpoint]") {
  StoppedScript script(column() +
                       "print 'first'\nmodel:traction{ on = 'x+', stress = {1e6, 0, 0} }\n"
                       "model:relax{}\nlocal t = cdem.elapsed()\nmodel:checkpoint()\nprint 'second'\n"
                       "print(cdem.elapsed() >= t)\nif not io.open('go') then error 'fails' end\n"
                       "print(model:max('displacement.x') > 0, 'third')");
  CHECK_THAT(script.error(), Contains("fails"));
  script.write("go", "");
  script.go_on_from_newest();
  script.listener->lines.clear();
  script.run();
  REQUIRE(script.listener->lines.size() == 4);
  CHECK_THAT(script.listener->lines[0], Contains("goes on from"));
  CHECK(script.listener->lines[1] == "second");
  CHECK(script.listener->lines[2] == "true");
  CHECK(script.listener->lines[3] == "true\tthird");
}

TEST_CASE("resume: a script, a file it requires or a model that has changed is refused in one line",
          "[checkpoint]") {
  const auto refused = [](const std::function<void(StoppedScript&)>& change) {
    StoppedScript script(plate);
    REQUIRE_FALSE(script.ends_before(60));
    script.go_on_from_newest();
    change(script);
    const std::string error = script.error();
    CHECK(error.find('\n') == std::string::npos);
    CHECK(script.wrote("checkpoint_1.cdem")); // still there
    return error;
  };
  CHECK_THAT(refused([](StoppedScript& s) { s.write("case.lua", std::string(plate) + "\n"); }),
             Contains("has changed since its checkpoint"));
  CHECK_THAT(refused([](StoppedScript& s) { s.write("helper.lua", "return { factor = 1.0 }"); }),
             Contains("require helper with other values"));
  CHECK_THAT(refused([](StoppedScript& s) { s.set("a", "1"); }), Contains("other --set values"));
}

TEST_CASE("resume: without a checkpoint, or with two that are damaged, it says so", "[checkpoint]") {
  StoppedScript script(plate);
  CHECK_THROWS_WITH(newest_checkpoint(script.settings.output), Contains("no checkpoint"));
  REQUIRE_FALSE(script.ends_before(60));
  fs::resize_file(script.settings.output / "checkpoint_1.cdem", 100);
  CHECK_THROWS_WITH(newest_checkpoint(script.settings.output), Contains("damaged"));
}

TEST_CASE("a saved state is where another script begins", "[checkpoint]") {
  const std::string pull = "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n";
  Script first(column() + pull +
               "model:relax{}\nmodel:save_state{ file = 'pulled.cdem' }\n"
               "model:run{ steps = 50 }\nprint(model.state_hash)");
  const std::string hash = first.printed();
  const std::string state = first.read("pulled.cdem");
  const std::string load = "model:load_state{ file = 'pulled.cdem' }\n";
  {
    Script second(column() + pull + load + "model:run{ steps = 50 }\nprint(model.state_hash)");
    second.write("pulled.cdem", state);
    CHECK(second.printed() == hash);
  }
  Script other(column("{4, 1, 1}") + load);
  other.write("pulled.cdem", state);
  CHECK_THAT(other.error(), Contains("case.lua:") && Contains("not the one that was saved"));
  Script damaged(column() + load);
  damaged.write("pulled.cdem", state.substr(0, state.size() - 1));
  CHECK_THROWS_WITH(damaged.run(), Contains("damaged"));
  CHECK_THAT(error_of(column() + "model:save_state{ file = 'pulled.vtu' }"), Contains(".cdem"));
  CHECK_THAT(error_of(column() + "model:run{ steps = 20, every = 1, callback = function() "
                                 "model:save_state{ file = 'a.cdem' } end }"),
             Contains("not from a callback"));
}

// A whole state file, checksum and all, of a model that has broken bonds, faces of meshes and contacts, with other bytes
// somewhere in it. Where they stand is the same in every run.
TEST_CASE("a forged state ends in one line or is taken, and never crashes", "[checkpoint]") {
  const std::string build =
      "local cdem = require 'cdem'\n"
      "local rock = cdem.elastic{ youngs_modulus = 1e7, poissons_ratio = 0.2, density = 2500 }\n"
      "local joint = cdem.mohr_coulomb{ cohesion = 1e3, friction_angle = 30, tensile_strength = 1e3 }\n"
      "local ground = cdem.box_mesh{ size = {2, 2, 1}, divisions = {2, 2, 1} }\n"
      "local unit = cdem.voronoi{ size = {1, 1, 1}, count = 4, origin = {0.5, 0.5, 1.0} }\n"
      "local model = cdem.model{ bodies = {\n"
      "  { shape = ground, material = rock, joint = joint, bonds = 'springs', name = 'ground' },\n"
      "  { shape = unit, material = rock, joint = joint, name = 'unit' } },\n"
      "  contacts = { default = cdem.coulomb{ friction_angle = 30 } } }\n"
      "model:fix{ on = 'z-', axes = 'xyz' }\nmodel:gravity{ vector = {0, 0, -9.81} }\n";
  Script first(build +
               "model:initial_velocity{ on = 'unit', velocity = {0, 0, -2} }\nmodel:run{ steps = 300 }\n"
               "model:save_state{ file = 'state.cdem' }\nprint(#model:breaks() > 0, "
               "model:contacts().acting > 0)");
  CHECK_THAT(first.printed(), Catch::Matchers::EndsWith("true\ttrue"));
  const std::string whole = cdem::read_saved(first.settings.output / "state.cdem", cdem::SavedKind::state);
  const std::string load =
      build + "model:load_state{ file = 'state.cdem' }\nmodel:run{ steps = 3 }\nprint 'taken'";
  int refused = 0, taken = 0;
  const auto try_forged = [&](const std::string& content) {
    Script script(load);
    cdem::write_saved(script.folder / "state.cdem", cdem::SavedKind::state, content);
    try {
      script.run();
      ++taken;
    } catch (const ScriptError& error) {
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
      ++refused;
    } catch (const cdem::SolutionError&) {
      ++taken;
    }
  };
  // A field stands as its name, its length in bytes and its data.
  for (const std::string name :
       {"displacement", "velocity", "bond_offset", "bond_mode", "released", "initial_stress", "stress",
        "faces", "face_slip", "contacts", "rigid", "displacement_zero", "escaped"}) {
    INFO(name);
    const std::uint64_t letters = name.size();
    const std::string head = std::string(reinterpret_cast<const char*>(&letters), sizeof letters) + name;
    const std::size_t length_at = whole.find(head) + head.size(), data_at = length_at + 8;
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, &whole[length_at], sizeof bytes);
    for (const std::int64_t more : {-88, -8, 8, 88}) { // entries of eight bytes and of a contact
      const std::uint64_t other = bytes + static_cast<std::uint64_t>(more);
      if (more < 0 && bytes < static_cast<std::uint64_t>(-more))
        continue;
      std::string forged = whole;
      std::memcpy(&forged[length_at], &other, sizeof other);
      if (more > 0)
        forged.insert(data_at + bytes, static_cast<std::size_t>(more), '\1');
      else
        forged.erase(data_at + other, static_cast<std::size_t>(-more));
      try_forged(forged);
    }
    const bool indices = name == "bond_mode" || name == "faces" || name == "contacts";
    for (std::uint64_t i = 0; indices && i < 40; ++i) {
      std::string forged = whole;
      const auto draw = geom::philox({static_cast<std::uint32_t>(i), 0, 0, 0}, {7, 0});
      const std::uint32_t values[] = {0xffffffffu, 0x7fffffffu, 0x80000000u, draw[2] % 4096u};
      const std::size_t record = name == "contacts" ? sizeof(cdem::Contact) : 4, // its indices stand first
          words = name == "contacts" ? 4 : 1,
                        at = record * (draw[0] % (bytes / record)) + 4 * (draw[1] % words);
      std::memcpy(&forged[data_at + at], &values[i % 4], 4);
      try_forged(forged);
    }
  }
  CHECK(refused > 100);
  CHECK(taken > 0);
}

TEST_CASE("what to type to go on is quoted where a shell would part it", "[lua]") {
  CHECK(cdem::script::resume_command("results/plate-a=1,b=2", false) == "cdem resume results/plate-a=1,b=2");
  CHECK(cdem::script::resume_command("my run", true) == "cdem resume 'my run' --unsafe");
  CHECK(cdem::script::resume_command("it's", false) == "cdem resume 'it'\\''s'");
}

TEST_CASE("resume: the journal of a script that reads without end is bounded", "[checkpoint]") {
  cdem::script::Journal journal;
  cdem::script::Event read;
  read.name = "model:read";
  read.value = std::string(std::size_t{8} << 20, 'x');
  std::size_t largest = 0;
  for (int i = 0; i < 100; ++i) {
    journal.record(read);
    largest = std::max(largest, journal.size());
  }
  CHECK(journal.full());
  CHECK(largest <= cdem::script::Journal::most);
  CHECK(journal.size() == 0); // nothing is kept that nobody can go on from
}
