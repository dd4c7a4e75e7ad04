// Files as wholes. A named pipe or a device may never end, and opening one may wait for ever: only regular files are read.
#pragma once

#include <filesystem>
#include <string>

namespace geom {

// Why the file cannot be read as a whole: "no such file", "is a folder, not a file", "is a named pipe, not a file" ...; empty
// where it can.
std::string why_not_regular(const std::filesystem::path&);

// All bytes. Throws std::runtime_error with the path and the reason.
std::string read_regular(const std::filesystem::path&);

} // namespace geom
