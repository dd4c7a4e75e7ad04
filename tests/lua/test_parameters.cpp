#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string parameters_head = "local cdem = require 'cdem'\n";

std::string value_of(const std::string& declaration, const std::string& typed) {
  Script script(parameters_head + "local p = cdem.parameter{ name = 'p', " + declaration +
                " }\nprint(math.type(p) or type(p), cdem.describe(p))");
  return script.set("p", typed).printed();
}

std::string error_for(const std::string& declaration, const std::string& typed) {
  Script script(parameters_head + "cdem.parameter{ name = 'p', " + declaration + " }");
  return script.set("p", typed).error();
}

} // namespace

TEST_CASE("a parameter without --set has its default", "[lua]") {
  CHECK(printed_by(parameters_head + "print(cdem.parameter{ name = 'pressure', default = 30e6 })") ==
        "30000000.0");
}

TEST_CASE("the option --set is read with the type of the default", "[lua]") {
  CHECK(value_of("default = 30e6", "24e6") == "float\t24000000.0");
  CHECK(value_of("default = 3", "7") == "integer\t7");
  CHECK(value_of("default = 3", "1e3") == "integer\t1000");
  CHECK(value_of("default = 3, type = 'number'", "2.5") == "float\t2.5");
  CHECK(value_of("default = 'elastic'", "full run") == "string\tfull run");
  CHECK(value_of("default = true", "false") == "boolean\tfalse");
  CHECK(value_of("default = {1, 2}", "0.1,0.2,3") == "table\t{0.1, 0.2, 3.0}");
  CHECK(value_of("default = {'a'}", "b, c") == "table\t{\"b\", \"c\"}");
}

TEST_CASE("a --set that cannot be read says what it must be", "[lua]") {
  CHECK_THAT(error_for("default = 30e6", "much"),
             Contains("case.lua:2: cdem.parameter: --set p=much: must be a number"));
  CHECK_THAT(error_for("default = 30e6", "nan"), Contains("must be a number"));
  CHECK_THAT(error_for("default = 30e6", "1e999"), Contains("must be a number"));
  CHECK_THAT(error_for("default = 30e6", ""), Contains("must be a number"));
  CHECK_THAT(error_for("default = 30e6", "3e6 Pa"), Contains("must be a number"));
  CHECK_THAT(error_for("default = 3", "2.5"), Contains("a whole number, as its default is one"));
  CHECK_THAT(error_for("default = true", "1"), Contains("must be true or false"));
  CHECK_THAT(error_for("default = {1, 2}", "1,,2"), Contains("must be a number"));
}

TEST_CASE("ranges and choices hold for the default and for --set", "[lua]") {
  CHECK_THAT(error_for("default = 1.0, range = {0, 2}", "2.5"), Contains("--set p = 2.5: must be in [0, 2]"));
  CHECK_THAT(error_for("default = 1.0, range = {0, 2}, unit = 'Pa'", "2.5"),
             Contains("--set p = 2.5: must be in [0, 2]; it is in Pa"));
  CHECK_THAT(error_for("default = 1.0, unit = 'Pa'", "24MPa"), Contains("e.g. 24e6; it is in Pa"));
  CHECK_THAT(error_for("default = {1, 2}, range = {0, 2}", "1,3"),
             Contains("--set p[2] = 3: must be in [0, 2]"));
  CHECK_THAT(error_for("default = 'fine', choices = {'fine', 'coarse'}", "corse"),
             Contains("must be one of fine, coarse; did you mean coarse?"));
  CHECK_THAT(error_of(parameters_head + "cdem.parameter{ name = 'p', default = 5.0, range = {0, 2} }"),
             Contains("default = 5: must be in [0, 2]"));
  CHECK_THAT(error_of(parameters_head + "cdem.parameter{ name = 'p', default = 5.0, range = {2, 0} }"),
             Contains("range = {2, 0}: must be {lowest, highest}"));
}

TEST_CASE("a --set that no parameter takes is an error that names the nearest", "[lua]") {
  Script script(parameters_head + "cdem.parameter{ name = 'pressure', default = 30e6 }");
  script.set("presure", "1");
  CHECK(script.error() == "case.lua: --set presure=1: the script has no such parameter; did you mean "
                          "pressure? Declared: pressure");
}

TEST_CASE("a misspelt --set is noticed before anything is solved", "[lua]") {
  Script script(column() + "model:traction{ on = 'x+', stress = {1, 0, 0} }\nmodel:relax{}\nprint 'solved'");
  script.set("presure", "1");
  CHECK_THAT(script.error(), Contains("model:relax: --set presure=1"));
  CHECK(script.listener->lines.empty());
}

TEST_CASE("a parameter is declared once, and before the first solving call", "[lua]") {
  CHECK_THAT(error_of(parameters_head +
                      "cdem.parameter{ name = 'p', default = 1 }\ncdem.parameter{ name = 'p', default = 1 }"),
             Contains("case.lua:3: cdem.parameter: name = \"p\": declared twice"));
  CHECK_THAT(error_of(column() + "model:traction{ on = 'x+', stress = {1, 0, 0} }\nmodel:relax{}\n"
                                 "cdem.parameter{ name = 'p', default = 1 }"),
             Contains("declared after the first solving call"));
}

TEST_CASE("the declared parameters are listed for the command line", "[lua]") {
  Script script(
      parameters_head +
      "cdem.parameter{ name = 'pressure', default = 30e6, range = {0, 1e9}, unit = 'Pa', doc = 'on top' }");
  script.set("pressure", "24e6");
  script.run();
  const auto all = script.engine->parameters();
  REQUIRE(all.size() == 1);
  CHECK(all[0].name == "pressure");
  CHECK(all[0].type == "number");
  CHECK(std::stod(all[0].default_text) == 30e6);
  CHECK(std::stod(all[0].value_text) == 24e6);
  CHECK(all[0].range_text == "in [0, 1e+09]");
  CHECK(all[0].unit == "Pa");
  CHECK(all[0].doc == "on top");
}
