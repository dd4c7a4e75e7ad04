#include "apps/cdem/live/saved_files.hpp"

#include "apps/cdem/process/failure.hpp"
#include "libcdem/vtk/files.hpp"

#include <algorithm>
#include <set>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

SavedFile series(const fs::path& file) {
  SavedFile one{file.filename().string(), {}};
  for (const std::string& name : read_pvd(file.string()))
    one.steps.push_back(file.parent_path() / name);
  return one;
}

// "run_bonds.vtu" beside "run.vtu" or "run.pvtu".
bool goes_with_another(const fs::path& file, const std::set<fs::path>& all) {
  const std::string stem = file.stem().string();
  for (const std::string end : {"_bonds", "_contacts"})
    if (stem.size() > end.size() && stem.compare(stem.size() - end.size(), end.size(), end) == 0)
      for (const std::string& extension :
           {file.extension().string(), std::string(".vtu"), std::string(".pvtu")})
        if (all.count(file.parent_path() / (stem.substr(0, stem.size() - end.size()) + extension)) > 0)
          return true;
  return false;
}

std::vector<SavedFile> files_of_folder(const fs::path& folder) {
  std::set<fs::path> all, listed;
  for (const auto& entry : fs::directory_iterator(folder))
    all.insert(entry.path());
  std::vector<SavedFile> found;
  for (const fs::path& file : all)
    if (file.extension() == ".pvd" && !goes_with_another(file, all)) {
      found.push_back(series(file));
      listed.insert(found.back().steps.begin(), found.back().steps.end());
    }
  for (const fs::path& file : all)
    if (is_saved_state(file) && listed.count(file) == 0 && !goes_with_another(file, all))
      found.push_back({file.filename().string(), {file}});
  if (found.empty())
    throw UsageError(folder.string() +
                     " holds no .vtu, .pvtu or .vtkhdf file and no series: nothing to look at");
  return found;
}

} // namespace

bool is_saved_state(const fs::path& file) {
  return file.extension() == ".vtu" || file.extension() == ".pvtu" || file.extension() == ".vtkhdf";
}

std::vector<SavedFile> saved_files(const fs::path& path) {
  std::error_code none;
  if (fs::is_directory(path, none))
    return files_of_folder(path);
  if (path.extension() == ".pvd")
    return {series(path)};
  if (is_saved_state(path))
    return {{path.filename().string(), {path}}};
  throw UsageError(path.string() +
                   ": must be a .vtu, .pvtu or .vtkhdf file, a .pvd series or a folder of results");
}

} // namespace cdem::app
