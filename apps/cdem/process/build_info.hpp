// What this program is.
#pragma once

#include <filesystem>
#include <string>

namespace cdem::app {

std::string version();                // "0.1.0"
std::string build_text();             // "Release, GNU 12.2.0"
std::filesystem::path program_path(); // of the running cdem

} // namespace cdem::app
