// The Lua text of a sweep: its script and the files that it requires, as they are when the sweep begins. So all runs
// execute the same text, even if the files are edited meanwhile.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace cdem::script {

// Folder in the output folder of a sweep: holds the scripts that its runs execute.
inline constexpr const char* sources_folder = "swept";

// Where the file of `require "a.b"` stands, from the script's folder: a/b.lua.
std::filesystem::path file_of_module(const std::string& name);

// Hands `keep` the name, from the script's folder, and the text of the script and of each file beside it that a
// `require "name"` in one of them names in quotes. Throws FileError.
void each_source(const std::filesystem::path& script,
                 const std::function<void(const std::filesystem::path& name, const std::string& text)>& keep);

// The kept text of a file of that name, in a folder of kept sources (empty: none are kept); the file itself where it
// was not kept.
std::filesystem::path kept_source(const std::filesystem::path& sources, const std::filesystem::path& name,
                                  const std::filesystem::path& file);

} // namespace cdem::script
