#include "apps/cdem/results/records.hpp"

#include "lua/binding/files/files.hpp"
#include "lua/binding/text/json.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace cdem::app {

namespace {

using json = nlohmann::ordered_json;
using script::FileError;

json read(const std::filesystem::path& file) {
  const std::string text = script::read_file_here(file);
  try {
    return json::parse(script::shallow_json(text));
  } catch (const std::exception&) {
    throw FileError(file.string() + " is not a JSON file");
  }
}

std::string text_of(const json& value) {
  if (value.is_null())
    return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string member(const json& object, const char* name) {
  return object.is_object() && object.contains(name) ? text_of(object[name]) : "";
}

// A number stays a number where its text is one.
json value_of(const std::string& type, const std::string& text) {
  if (type == "string")
    return text;
  try {
    return json::parse(script::shallow_json(text));
  } catch (const std::exception&) {
    return text;
  }
}

} // namespace

void write_settings(const RunRecord& record, const std::filesystem::path& file) {
  json parameters = json::object();
  for (const auto& p : record.parameters)
    parameters[p.name] = {{"value", value_of(p.type, p.value_text)}, {"unit", p.unit}};
  json settings = {{"script", record.script}, {"version", record.version}, {"threads", record.threads},
                   {"unsafe", record.unsafe}, {"set", record.set},         {"parameters", parameters}};
  json& ranks = settings["ranks"] = json::array();
  for (const RankLoad& load : record.ranks)
    ranks.push_back({{"host", load.host},
                     {"messages", load.messages},
                     {"bytes", load.bytes},
                     {"waited_s", load.waited},
                     {"passed_s", load.passed}});
  if (record.ranks.empty())
    settings.erase("ranks");
  std::ofstream out(file);
  out << settings.dump(2, ' ', false, json::error_handler_t::replace) << '\n';
  if (!out.flush())
    throw FileError(file.string() + " cannot be written: " + std::strerror(errno));
}

std::vector<Figure> read_report(const std::filesystem::path& file) {
  const json report = read(file);
  std::vector<Figure> figures;
  if (report.is_object() && report.contains("figures"))
    for (const auto& f : report["figures"])
      figures.push_back({member(f, "name"), member(f, "value"), member(f, "unit"), member(f, "reference"),
                         member(f, "kind"), member(f, "within")});
  return figures;
}

std::vector<Parameter> read_parameters(const std::filesystem::path& settings_file) {
  const json settings = read(settings_file);
  std::vector<Parameter> parameters;
  if (settings.is_object() && settings.contains("parameters"))
    for (const auto& [name, parameter] : settings["parameters"].items())
      parameters.push_back({name, member(parameter, "value"), member(parameter, "unit")});
  return parameters;
}

std::string name_with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + " (" + unit + ")";
}

} // namespace cdem::app
