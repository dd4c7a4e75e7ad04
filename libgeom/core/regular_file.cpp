#include "libgeom/core/regular_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace geom {

std::string why_not_regular(const std::filesystem::path& path) {
  using std::filesystem::file_type;
  std::error_code error;
  switch (std::filesystem::status(path, error).type()) {
  case file_type::regular:
    return "";
  case file_type::not_found:
    return "no such file";
  case file_type::directory:
    return "is a folder, not a file";
  case file_type::fifo:
    return "is a named pipe, not a file";
  case file_type::socket:
    return "is a socket, not a file";
  case file_type::block:
  case file_type::character:
    return "is a device, not a file";
  default:
    return "cannot be read: " + error.message();
  }
}

std::string read_regular(const std::filesystem::path& path) {
  if (const std::string why = why_not_regular(path); !why.empty())
    throw std::runtime_error(path.string() + ": " + why);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in && in.peek() != std::ifstream::traits_type::eof())
    text << in.rdbuf();
  if (!in.is_open() || in.bad() || text.bad())
    throw std::runtime_error(path.string() + ": cannot be read" +
                             (errno != 0 ? ": " + std::string(std::strerror(errno)) : ""));
  return text.str();
}

} // namespace geom
