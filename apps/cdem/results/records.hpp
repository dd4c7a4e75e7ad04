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
std::vector<std::pair<std::string, std::string>> read_parameters(const std::filesystem::path& settings_file);

} // namespace cdem::app
