// What a script can be given and can say: files of piles and tables, and the arguments of every function of the module.
#include "tests/fuzz/targets.hpp"

#include "libcdem/vtk/file_error.hpp"
#include "libgeom/core/error.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/pile_object.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>

namespace fuzz {

namespace {

class Silent final : public cdem::Observer {
public:
  void message(const std::string&) override {}
  bool stop_requested() override { return ++looks > 200; } // what takes long is not what is looked for

private:
  int looks = 0;
};

void run_script(const std::string& text) {
  cdem::script::EngineSettings settings;
  settings.script = as_file("case.lua", text);
  settings.output = settings.script.parent_path() / "out";
  settings.results = settings.output;
  settings.observer = std::make_shared<Silent>();
  settings.check_only = true;
  settings.memory = std::size_t{256} << 20;
  cdem::script::Engine engine(settings);
  try {
    engine.run_file();
  } catch (const cdem::script::ScriptError& error) {
    if (std::string(error.what()).find("internal") != std::string::npos)
      std::abort();
  }
}

std::string value(Draw& draw, int nested = 0);

std::string list(Draw& draw, int nested) {
  std::string text = "{";
  for (std::uint32_t n = draw.byte() % 5; n > 0; --n)
    text += " " + value(draw, nested + 1) + ",";
  return text + " }";
}

// A value as Lua writes it: what a script would give, and what nobody would.
std::string value(Draw& draw, int nested) {
  static const std::array<const char*, 40> simple = {"0",
                                                     "1",
                                                     "2",
                                                     "3",
                                                     "-1",
                                                     "0.5",
                                                     "1e-3",
                                                     "1e-300",
                                                     "1e300",
                                                     "1/0",
                                                     "-1/0",
                                                     "0/0",
                                                     "1 << 31",
                                                     "1 << 53",
                                                     "math.mininteger",
                                                     "math.maxinteger",
                                                     "1e6",
                                                     "nil",
                                                     "true",
                                                     "false",
                                                     "''",
                                                     "'x+'",
                                                     "'a'",
                                                     "'xyz'",
                                                     "'z-'",
                                                     "'all'",
                                                     "('x'):rep(1000)",
                                                     "'\\0'",
                                                     "print",
                                                     "function() end",
                                                     "function() return 1 end",
                                                     "function() error 'e' end",
                                                     "{1, 1, 1}",
                                                     "{0, 0, 1}",
                                                     "shape",
                                                     "rock",
                                                     "joint",
                                                     "solid",
                                                     "mesh",
                                                     "model"};
  const std::uint32_t which = draw.byte();
  if (nested < 3 && which % 8 == 7)
    return list(draw, nested);
  return simple[which % simple.size()];
}

std::string table(Draw& draw, const std::vector<cdem::script::Field>& fields) {
  std::string text = "{";
  for (const auto& field : fields)
    if (field.must || draw.byte() % 2 == 1) {
      if (!field.type.fields.empty() && draw.byte() % 4 != 0)
        text += " " + field.name + " = " + table(draw, field.type.fields) + ",";
      else
        text += " " + field.name + " = " + value(draw) + ",";
    }
  if (draw.byte() % 16 == 15)
    text += " " + value(draw) + ", surplus = 1,";
  return text + " }";
}

const char* const before =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2000 }\n"
    "local joint = cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e6 }\n"
    "local shape = cdem.grid{ size = {1, 1, 1}, divisions = {2, 1, 1} }\n"
    "local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }\n"
    "local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint } } }\n";

// Some start processes or OpenCASCADE, which takes too long for this.
bool is_left_out(const std::string& name) {
  static const std::set<std::string> names = {"sweep", "place", "drop"};
  return names.count(name) > 0 || name.rfind("solid", 0) == 0 || name.rfind("armour", 0) == 0;
}

} // namespace

void pile(const std::string& bytes) {
  cdem::script::pile_from(bytes, "pile.json");
}

void csv(const std::string& bytes) {
  as_file("table.csv", bytes);
  run_script("require('cdem').read_csv{ file = 'table.csv' }");
}

void record(const std::string& bytes) {
  const bool peer = !bytes.empty() && static_cast<unsigned char>(bytes[0]) % 2 == 1;
  as_file(peer ? "table.AT2" : "table.csv", bytes.empty() ? bytes : bytes.substr(1));
  run_script(peer ? "require('cdem').record{ path = 'table.AT2', unit = 'g' }"
                  : "require('cdem').record{ path = 'table.csv', time = '1', value = '2', unit = 'g' }");
}

void arguments(const std::string& bytes) {
  const auto& module = cdem::script::module();
  std::string text = before;
  Draw draw(bytes);
  for (int calls = 0; draw.any() && calls < 8; ++calls) {
    const bool of_model = draw.byte() % 2 == 1;
    const auto& all =
        of_model ? const_cast<cdem::script::Module&>(module).the_class("Model").methods : module.functions;
    const auto& function = all[draw.word() % all.size()];
    if (is_left_out(function.name))
      continue;
    std::string given;
    if (function.in_order)
      for (std::uint32_t n = draw.byte() % 4; n > 0; --n)
        given += (given.empty() ? "" : ", ") + value(draw);
    else
      given = table(draw, function.fields);
    text += "pcall(function() return " + std::string(of_model ? "model:" : "cdem.") + function.name + "(" +
            given + ") end)\n";
  }
  run_script(text);
}

} // namespace fuzz
