// What can be looked at below a path: saved states, and series of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cdem::app {

// A .vtu or .vtkhdf by its name.
bool is_saved_state(const std::filesystem::path&);

struct SavedFile {
  std::string name;                         // as the page lists it
  std::vector<std::filesystem::path> steps; // one state each
};

// A .vtu or .vtkhdf file gives itself, of a .pvd: its files. Of a folder: its series by name, then its files that stand in
// none; without those of bonds and contacts, which are drawn or stand beside the blocks. Throws UsageError for anything
// else and for a folder without any.
std::vector<SavedFile> saved_files(const std::filesystem::path&);

} // namespace cdem::app
