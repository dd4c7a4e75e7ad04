#include "lua/binding/module/module.hpp"
#include "lua/binding/module/topics.hpp"
#include "tests/lua/script.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

using namespace cdem::script;
using namespace cdem::script::test;

TEST_CASE("the committed reference page is the one the binding generates", "[lua]") {
  INFO("make it anew: cmake --build <build folder> --target lua_reference");
  CHECK(read_file(fs::path(CDEM_SOURCE) / "docs/script-reference.md") == reference());
}

TEST_CASE("every declared function is in the module, and nothing else", "[lua]") {
  std::string declared;
  for (const Function& f : module().functions)
    declared +=
        "assert(type(cdem." + f.name + ") == 'function', '" + f.name + "')\nknown['" + f.name + "'] = true\n";
  for (const Constant& c : module().constants)
    declared += "known['" + c.name + "'] = true\n";
  CHECK(error_of("local cdem, known = require 'cdem', {}\n" + declared +
                 "for name, entry in pairs(cdem) do\n"
                 "  if type(entry) == 'table' then\n"
                 "    for inner in pairs(entry) do assert(known[name .. '.' .. inner], inner) end\n"
                 "  else assert(known[name], name) end\nend") == "");
}

TEST_CASE("what one rank does for all calls nothing of the script, and gives back what can be told",
          "[lua]") {
  const std::function<bool(const Type&)> calls = [&](const Type& type) {
    return type.kind == Kind::function || type.kind == Kind::place ||
           std::any_of(type.items.begin(), type.items.end(), calls) ||
           std::any_of(type.fields.begin(), type.fields.end(), [&](const Field& f) { return calls(f.type); });
  };
  std::vector<const Function*> led;
  const auto gather = [&](const std::vector<Function>& functions) {
    for (const Function& f : functions)
      if (f.led)
        led.push_back(&f);
  };
  gather(module().functions);
  for (const Class& c : module().classes)
    gather(c.methods);
  REQUIRE(led.size() > 10);
  for (const Function* const f : led) {
    INFO(f->name);
    CHECK(std::none_of(f->fields.begin(), f->fields.end(),
                       [&](const Field& field) { return calls(field.type); }));
    for (const Class& c : module().classes)
      CHECK(f->returns.find("cdem." + c.name) == std::string::npos);
  }
}

TEST_CASE("every function has an example in the reference, and no example is of another name", "[lua]") {
  std::vector<std::string> names;
  for (const Topic& topic : topics()) {
    INFO(topic.file);
    CHECK_FALSE(example_preamble(topic.file).empty()); // its file is there
    for (const std::string& name : topic.names) {
      INFO(name);
      CHECK_FALSE(example_of(name).empty());
      CHECK(help(name).find(example_of(name)) != std::string::npos);
      names.push_back(name);
    }
  }
  for (const std::string& name : examples()) {
    INFO(name);
    CHECK(std::find(names.begin(), names.end(), name) != names.end());
  }
}

TEST_CASE("help tells about topics, classes and short names, and names the nearest for others", "[lua]") {
  CHECK(help("").find("materials") != std::string::npos);
  CHECK(help("fix").find("model:fix{ on, ... }") == 0);
  CHECK(help("Model").find("model:relax") != std::string::npos);
  CHECK(help("settling").find("model:watch") != std::string::npos);
  CHECK_THROWS_WITH(help("model:fixx"), Catch::Contains("model:fix"));
}

TEST_CASE("every default satisfies its own declaration", "[lua]") {
  const auto check_fields = [](const std::vector<Field>& fields) {
    for (const Field& f : fields)
      if (!f.standard_value.is_nil())
        CHECK_NOTHROW(check_value(f.standard_value, f.type, f.name));
  };
  for (const Function& f : module().functions)
    check_fields(f.fields);
  for (const Class& c : module().classes)
    for (const Function& f : c.methods)
      check_fields(f.fields);
}

TEST_CASE("every class and table that an annotation mentions is declared", "[lua]") {
  const std::string text = annotations();
  for (auto at = text.find("cdem."); at != std::string::npos; at = text.find("cdem.", at + 1)) {
    std::size_t end = at + 5;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
      ++end;
    const std::string name = text.substr(at, end - at);
    if (name.size() < 6 || !std::isupper(static_cast<unsigned char>(name[5])))
      continue; // a function, not a type
    INFO(name);
    const bool declared = text.find("---@class " + name + "\n") != std::string::npos ||
                          text.find("---@class (exact) " + name + "\n") != std::string::npos ||
                          text.find("---@alias " + name + " ") != std::string::npos;
    CHECK(declared);
  }
}
