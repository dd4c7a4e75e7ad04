#include "apps/cdem/process/build_info.hpp"

namespace cdem::app {

std::string version() {
  return CDEM_VERSION;
}
std::string build_text() {
  return CDEM_BUILD_TYPE ", " CDEM_COMPILER;
}

std::filesystem::path program_path() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path("cdem") : path;
}

} // namespace cdem::app
