#include "apps/cdem/commands/script_run.hpp"

#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/text/text.hpp"
#include "libgeom/core/regular_file.hpp"
#include "lua/binding/text/nearest.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sched.h>
#include <unistd.h>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

// "; there is x.lua" for a name that nearly fits one in the same folder.
std::string similar_file(const fs::path& file) {
  std::vector<std::string> names;
  std::error_code none;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, none))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return script::did_you_mean(file.filename().string(), names);
}

} // namespace

bool is_there(const fs::path& path) {
  std::error_code error;
  const bool found = fs::exists(path, error);
  if (error)
    throw script::FileError(path.string() + " cannot be read: " + error.message());
  return found;
}

void require_script(const fs::path& script) {
  std::error_code none;
  if (!is_there(script))
    throw script::FileError(script.string() + ": no such file" + similar_file(script));
  if (fs::is_directory(script, none)) {
    const fs::path inside = script / "case.lua";
    throw UsageError(
        script.string() + " is a folder, not a script" +
        (fs::exists(inside, none) ? "; did you mean '" + inside.string() + "'?" : std::string()));
  }
  if (const std::string why = geom::why_not_regular(script); !why.empty())
    throw script::FileError(script.string() + ": " + why);
  if (access(script.c_str(), R_OK) != 0)
    throw script::FileError(script.string() + " cannot be read: " + std::strerror(errno));
}

int available_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return sched_getaffinity(0, sizeof cores, &cores) == 0 ? std::max(1, CPU_COUNT(&cores)) : 1;
}

std::string parameter_table(const std::vector<script::ParameterInfo>& parameters) {
  std::vector<std::vector<std::string>> rows = {{"name", "value", "unit", "default", "range", "what it is"}};
  for (const auto& p : parameters)
    rows.push_back({p.name, p.value_text, p.unit, p.default_text, p.range_text, p.doc});
  return table_text(rows);
}

} // namespace cdem::app
