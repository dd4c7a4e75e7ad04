// The JSON files of an output folder; the only place that sees the JSON library.
#pragma once

#include "apps/cdem/process/rank.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cdem::app {

// settings.json: what a run was asked for and which parameters it used.
struct RunRecord {
  std::string script, version;
  int threads = 1;
  bool unsafe = false;
  std::map<std::string, std::string> set;
  std::vector<script::ParameterInfo> parameters;
  std::vector<RankLoad> ranks; // empty of one process alone
};
void write_settings(const RunRecord&, const std::filesystem::path& file); // throws script::FileError

// One figure of a report.json, every part as text ("" for null).
struct Figure {
  std::string name, value, unit, reference, kind, within;
};
std::vector<Figure> read_report(const std::filesystem::path& file); // throws script::FileError

// One parameter of a settings.json, likewise.
struct Parameter {
  std::string name, value, unit;
};
std::vector<Parameter>
read_parameters(const std::filesystem::path& settings_file); // throws script::FileError

// "peak_force (N)"; the name alone of what has no unit.
std::string name_with_unit(const std::string& name, const std::string& unit);

} // namespace cdem::app
