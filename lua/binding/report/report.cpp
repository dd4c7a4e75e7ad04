#include "lua/binding/report/report.hpp"

#include "lua/binding/schema/errors.hpp"
#include "lua/binding/text/json.hpp"
#include "lua/binding/text/markdown.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace cdem::script {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Value& value) {
  if (const auto* flag = value.get<bool>())
    return *flag;
  if (const auto* integer = value.get<std::int64_t>())
    return *integer;
  if (const auto* number = value.get<double>())
    return *number;
  if (const auto* text = value.get<std::string>())
    return *text;
  return nullptr;
}

Value from_json(const Json& json) {
  if (json.is_boolean())
    return json.get<bool>();
  if (json.is_number_integer())
    return json.get<std::int64_t>();
  if (json.is_number())
    return json.get<double>();
  if (json.is_string())
    return json.get<std::string>();
  if (json.is_array()) {
    Values items;
    for (const Json& item : json)
      items.push_back(from_json(item));
    return Table::list(std::move(items));
  }
  if (json.is_object()) {
    Table table;
    for (const auto& [name, entry] : json.items())
      if (!entry.is_null())
        table.named[name] = from_json(entry);
    return table;
  }
  return {};
}

// Six digits are what a reader compares; the .json has them all.
std::string shown(const Value& value) {
  if (value.is_nil())
    return "-";
  if (const auto* text = value.get<std::string>())
    return *text;
  if (const auto* number = value.get<double>()) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", *number);
    return buffer;
  }
  return describe(value);
}

std::string cell_or_dash(const std::string& text) {
  return text.empty() ? "-" : cell(text);
}

std::string difference(const Figure& f) {
  if (!f.value.is_number() || !f.reference.is_number())
    return "-";
  const double reference = f.reference.number(), apart = f.value.number() - reference;
  char buffer[48];
  if (reference != 0 && !f.absolute)
    std::snprintf(buffer, sizeof buffer, "%+.2f %%", 100 * apart / std::abs(reference));
  else
    std::snprintf(buffer, sizeof buffer, "%+.3g", apart);
  return buffer;
}

std::string tolerance_text(const Figure& f) {
  if (!f.tolerance)
    return "-";
  char buffer[48];
  if (f.absolute)
    std::snprintf(buffer, sizeof buffer, "%.3g%s%s", *f.tolerance, f.unit.empty() ? "" : " ", f.unit.c_str());
  else
    std::snprintf(buffer, sizeof buffer, "%.3g %%", 100 * *f.tolerance);
  return buffer;
}

} // namespace

std::optional<bool> Figure::within() const {
  if (kind == "trial" || kind.empty())
    return std::nullopt;
  if (const bool* ours = value.get<bool>(), *theirs = reference.get<bool>(); ours && theirs)
    return *ours == *theirs;
  if (!tolerance || !reference.is_number())
    return std::nullopt;
  if (!value.is_number())
    return std::nullopt;
  const double allowed = absolute ? *tolerance : *tolerance * std::abs(reference.number());
  return std::abs(value.number() - reference.number()) <= allowed;
}

void Report::add(const Figure& figure) {
  const auto same = [&](const Figure& f) { return f.name == figure.name; };
  const auto it = std::find_if(figures.begin(), figures.end(), same);
  if (it != figures.end())
    *it = figure;
  else
    figures.push_back(figure);
}

std::string Report::json() const {
  Json list = Json::array();
  for (const Figure& f : figures) {
    Json entry;
    entry["name"] = f.name;
    entry["value"] = to_json(f.value);
    entry["unit"] = f.unit;
    entry["reference"] = to_json(f.reference);
    entry["kind"] = f.kind.empty() ? Json(nullptr) : Json(f.kind);
    entry["source"] = f.source;
    entry["tolerance"] = f.tolerance ? Json(*f.tolerance) : Json(nullptr);
    if (f.absolute)
      entry["tolerance_absolute"] = true;
    if (f.kind != "trial") {
      const auto judged = f.within();
      entry["within"] = judged ? Json(*judged) : Json(nullptr);
    }
    list.push_back(entry);
  }
  Json all;
  all["schema"] = report_schema;
  all["case"] = case_name;
  all["figures"] = list;
  if (!relaxations.empty()) {
    Json verdicts = Json::array();
    for (const Table& row : relaxations) {
      Json entry;
      for (const auto& [name, value] : row.named)
        entry[name] = to_json(value);
      verdicts.push_back(entry);
    }
    all["relaxations"] = verdicts;
  }
  all["warnings"] = warnings;
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string Report::markdown() const {
  std::string out = "# " + case_name + "\n\n";
  out += "| figure | value | unit | reference | difference | kind | tolerance | within | source |\n";
  out += "|---|---:|---|---:|---:|---|---:|---|---|\n";
  for (const Figure& f : figures) {
    const auto judged = f.within();
    out += "| " + cell_or_dash(f.name) + " | " + cell_or_dash(shown(f.value)) + " | " + cell_or_dash(f.unit) +
           " | " + cell_or_dash(shown(f.reference)) + " | " + difference(f) + " | " + cell_or_dash(f.kind) +
           " | " + tolerance_text(f) + " | " + (judged ? (*judged ? "yes" : "**no**") : "-") + " | " +
           cell_or_dash(f.source) + " |\n";
  }
  if (!relaxations.empty())
    out += "\n| stage | model | trial | verdict | steps | residual |\n|---:|---:|---|---|---:|---:|\n";
  for (const Table& row : relaxations) {
    const auto entry = [&](const char* name) {
      const auto found = row.named.find(name);
      return cell_or_dash(shown(found == row.named.end() ? Value() : found->second));
    };
    out += "| " + entry("stage") + " | " + entry("model") + " | " + entry("trial") + " | " +
           entry("verdict") + " | " + entry("steps") + " | " + entry("residual") + " |\n";
  }
  if (!warnings.empty())
    out += "\nWarnings of the run:\n\n";
  for (const std::string& warning : warnings)
    out += "- " + cell_or_dash(warning) + "\n";
  return out;
}

Value read_report(const std::string& json_text, const std::string& shown_name) {
  try {
    return from_json(Json::parse(shallow_json(json_text)));
  } catch (const std::exception& error) { // of the text
    throw FileError(shown_name + ": not a report: " + json_reason(error));
  }
}

} // namespace cdem::script
