// What can be looked at below a path: saved states, and series of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cdem::app {

// A .vtu, .pvtu or .vtkhdf by its name.
bool is_saved_state(const std::filesystem::path&);

struct SavedFile {
  std::string name;                         // as the page lists it
  std::vector<std::filesystem::path> steps; // one state each
};

// The files to show. A .vtu, .pvtu or .vtkhdf file gives itself, a .pvd its files. A folder gives its series by name, then its
// files that are in no series. Files of bonds and contacts are left out: they are drawn with the blocks or are stored
// beside them. Throws UsageError for anything else and for a folder without such files.
std::vector<SavedFile> saved_files(const std::filesystem::path&);

} // namespace cdem::app
