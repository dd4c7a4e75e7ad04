#include "lua/binding/report/report.hpp"
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string report_head = "local cdem = require 'cdem'\n";

Figure figure(double value, double reference, const std::string& kind, double tolerance) {
  Figure f;
  f.name = "f";
  f.value = value;
  f.reference = reference;
  f.kind = kind;
  f.tolerance = tolerance;
  return f;
}

// The named entries of figure number i of a report.json.
std::map<std::string, Value> entry(const std::string& json, std::size_t i) {
  const Value all = read_report(json, "report.json");
  return all.table()->named.at("figures").table()->items.at(i).table()->named;
}

using Json = nlohmann::json;

bool has_type(const Json& value, const std::string& type) {
  return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
         (type == "string" && value.is_string()) || (type == "number" && value.is_number()) ||
         (type == "boolean" && value.is_boolean()) || (type == "null" && value.is_null());
}

// What a value breaks of the parts of JSON Schema that docs/report.schema.json uses; "" nothing.
std::string broken(const Json& schema, const Json& value, const std::string& at) {
  if (schema.is_boolean())
    return schema.get<bool>() ? "" : at + ": is not foreseen";
  if (schema.contains("const") && value != schema["const"])
    return at + ": not the constant";
  if (schema.contains("type")) {
    const Json types = schema["type"].is_array() ? schema["type"] : Json::array({schema["type"]});
    if (std::none_of(types.begin(), types.end(),
                     [&](const Json& type) { return has_type(value, type.get<std::string>()); }))
      return at + ": of another type";
  }
  if (value.is_object()) {
    for (const Json& name : schema.value("required", Json::array()))
      if (!value.contains(name.get<std::string>()))
        return at + ": lacks " + name.get<std::string>();
    for (const auto& [name, entry] : value.items()) {
      const Json known = schema.value("properties", Json::object());
      const Json rule = known.contains(name) ? known[name] : schema.value("additionalProperties", Json(true));
      if (const std::string wrong = broken(rule, entry, at + "." + name); !wrong.empty())
        return wrong;
    }
  }
  if (value.is_array() && schema.contains("items"))
    for (const Json& item : value)
      if (const std::string wrong = broken(schema["items"], item, at + "[]"); !wrong.empty())
        return wrong;
  return "";
}

} // namespace

TEST_CASE("report.json is as docs/report.schema.json says, with the version of the format", "[lua]") {
  const Json schema = Json::parse(read_file(std::string(CDEM_SOURCE) + "/docs/report.schema.json"));
  Script script(
      column() +
      "model:relax{ residual = 1e-3 }\n"
      "cdem.report{ { name = 'a', value = 1.5, unit = 'm', reference = 1.4, kind = 'formula', source = 's',\n"
      "    tolerance = 0.1 },\n"
      "  { name = 'b', value = true }, { name = 'c', value = 0/0 },\n"
      "  { name = 'd', value = 0, reference = 0, kind = 'formula', source = 's', tolerance_absolute = 1e-3 } "
      "}");
  REQUIRE(script.error() == "");
  Json report = Json::parse(script.read("report.json"));
  CHECK(report["schema"] == report_schema);
  CHECK(broken(schema, report, "report") == "");
  CHECK(report["relaxations"].size() == 1);
  report["figures"][0]["new"] = 1;
  CHECK(broken(schema, report, "report") == "report.figures[].new: is not foreseen");
  report["figures"][0].erase("new");
  report["figures"][1].erase("unit");
  CHECK(broken(schema, report, "report") == "report.figures[]: lacks unit");
}

TEST_CASE("a figure is within when it lies no further from the reference than the tolerance", "[lua]") {
  CHECK(figure(1.02, 1, "paper", 0.021).within() == true);
  CHECK(figure(1.02, 1, "paper", 0.019).within() == false);
  CHECK(figure(-2.1, -2, "fe", 0.06).within() == true); // relative to the size of the reference
  CHECK(figure(-2.1, -2, "fe", 0.04).within() == false);
  CHECK(figure(std::nan(""), 1, "fe", 1e9).within() == false);
  Figure absolute = figure(0.005, 0, "formula", 0.01);
  CHECK(absolute.within() == false); // nothing is within a relative tolerance of zero
  absolute.absolute = true;
  CHECK(absolute.within() == true);
}

TEST_CASE("a trial figure is never judged", "[lua]") {
  CHECK_FALSE(figure(1, 1, "trial", 1).within().has_value());
  Script script(report_head + "cdem.report{ { name = 'a', value = 1.0, reference = 1.0, kind = 'trial' } }");
  script.run();
  const std::string json = script.read("report.json");
  CHECK(json.find("within") == std::string::npos);
  CHECK(entry(json, 0).at("reference").number() == 1);
}

TEST_CASE("report.json has the case and every field of a figure", "[lua]") {
  Script script(
      report_head +
      "cdem.report{ { name = 'uy', value = -2.78e-4, unit = 'm', reference = -2.7375e-4, kind = 'fe', "
      "source = 'fine mesh', tolerance = 0.02 } }");
  script.run();
  const std::string json = script.read("report.json");
  const Value all = read_report(json, "report.json");
  CHECK(*all.table()->named.at("case").get<std::string>() == script.folder.filename().string());
  const auto f = entry(json, 0);
  CHECK(*f.at("name").get<std::string>() == "uy");
  CHECK(f.at("value").number() == -2.78e-4);
  CHECK(*f.at("unit").get<std::string>() == "m");
  CHECK(f.at("reference").number() == -2.7375e-4);
  CHECK(*f.at("kind").get<std::string>() == "fe");
  CHECK(*f.at("source").get<std::string>() == "fine mesh");
  CHECK(f.at("tolerance").number() == 0.02);
  CHECK(*f.at("within").get<bool>()); // 1.55 % apart
  CHECK_THAT(script.read("report.md"),
             Contains("| uy | -0.000278 | m | -0.00027375 | -1.55 % | fe | 2 % | yes | fine mesh |"));
}

TEST_CASE("values may be text or null, what is not finite becomes null with a warning", "[lua]") {
  Script script(
      report_head +
      "cdem.report{ { name = 'text', value = 'X' }, { name = 'none' }, { name = 'nan', value = 0/0 },\n"
      "  { name = 'inf', value = 1, reference = math.huge, kind = 'paper', tolerance = 1 } }");
  script.run();
  const std::string json = script.read("report.json");
  CHECK(*entry(json, 0).at("value").get<std::string>() == "X");
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}})
    CHECK(entry(json, i).count("value") == 0); // null reads as absent
  CHECK_THAT(json, Contains("\"value\": null"));
  CHECK_THAT(json, Contains("\"within\": null"));
  REQUIRE(script.listener->lines.size() == 2);
  CHECK_THAT(script.listener->lines[0], Contains("warning: cdem.report: nan: value is"));
  CHECK_THAT(script.listener->lines[1], Contains("warning: cdem.report: inf: reference is inf"));
}

TEST_CASE("further reports add figures, a name given again takes the earlier one's place", "[lua]") {
  Script script(report_head + "cdem.report{ { name = 'a', value = 1 }, { name = 'b', value = 2 } }\n"
                              "cdem.report{ { name = 'c', value = 3 }, { name = 'a', value = 4 } }");
  script.run();
  const std::string json = script.read("report.json");
  CHECK(entry(json, 0).at("value").number() == 4);
  CHECK(entry(json, 1).at("value").number() == 2);
  CHECK(*entry(json, 2).at("name").get<std::string>() == "c");
}

TEST_CASE("a report that cannot be judged is refused", "[lua]") {
  CHECK_THAT(error_of(report_head + "cdem.report{ { name = 'a', value = 1, reference = 2 } }"),
             Contains("a: kind: missing"));
  CHECK_THAT(
      error_of(report_head + "cdem.report{ { name = 'a', value = 1, reference = 2, kind = 'trail' } }"),
      Contains("did you mean \"trial\"?"));
  CHECK_THAT(
      error_of(report_head + "cdem.report{ { name = 'a', reference = 2, kind = 'trial', tolerance = 1 } }"),
      Contains("never judged"));
  CHECK_THAT(error_of(report_head + "cdem.report{ { name = 'a', tolerance = 1, tolerance_absolute = 1 } }"),
             Contains("not both"));
  CHECK_THAT(error_of(report_head + "cdem.report{ name = 'a', value = 1 }"),
             Contains("one more pair of braces"));
  CHECK_THAT(error_of(report_head + "cdem.report{ { value = 1 } }"), Contains("figures[1]: name: missing"));
}

TEST_CASE("booleans are reported, and judged by equality", "[lua]") {
  Script script(report_head +
                "cdem.report{ { name = 'whole', value = true, reference = true, kind = 'paper' },\n"
                "  { name = 'cut', value = false, reference = true, kind = 'paper' },\n"
                "  { name = 'converged', value = true } }");
  script.run();
  const std::string json = script.read("report.json");
  CHECK(*entry(json, 0).at("value").get<bool>());
  CHECK(*entry(json, 0).at("within").get<bool>());
  CHECK_FALSE(*entry(json, 1).at("within").get<bool>());
  CHECK(entry(json, 2).count("within") == 0);
  CHECK_THAT(script.read("report.md"), Contains("| cut | false |") && Contains("| **no** |"));
  CHECK_THAT(error_of(report_head + "cdem.report{ { name = 'a', value = { 1 } } }"),
             Contains("a boolean or nil"));
}
