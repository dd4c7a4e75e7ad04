#include "lua/binding/session.hpp"

#include "libgeom/core/error.hpp"
#include "lua/binding/nearest.hpp"

#include <algorithm>
#include <cstdio>

namespace cdem::script {

namespace {

std::filesystem::path output_folder(const EngineSettings& settings) {
  return settings.output.empty() ? std::filesystem::path("results") : settings.output;
}

} // namespace

Session::Session(EngineSettings given)
    : settings(std::move(given)),
      files(settings.script, output_folder(settings), settings.results, settings.unsafe) {
  files.will_write = settings.will_write;
  report.case_name = files.output().filename().string();
}

void Session::message(const std::string& line) const {
  if (settings.observer)
    settings.observer->message(line);
  else
    std::printf("%s\n", line.c_str());
}

void Session::warn(const std::string& text) {
  const std::string place = where ? where() : std::string();
  const std::string line = (place.empty() ? "" : place + ": ") + "warning: " + text;
  if (std::find(warnings.begin(), warnings.end(), line) != warnings.end())
    return;
  warnings.push_back(line);
  message(line);
}

void Session::check_set_names() const {
  std::vector<std::string> names;
  for (const Parameter& p : parameters)
    names.push_back(p.info.name);
  for (const auto& [name, value] : settings.set) {
    if (std::find(names.begin(), names.end(), name) != names.end())
      continue;
    throw geom::InputError("--set " + name + "=" + value + ": the script has no such parameter" +
                           did_you_mean(name, names) +
                           (names.empty() ? "; it declares none" : " Declared: " + joined(names)));
  }
}

} // namespace cdem::script
