#include "apps/cdem/build_info.hpp"

namespace cdem::app {

std::string version() {
  return CDEM_VERSION;
}
std::string build_text() {
  return CDEM_BUILD_TYPE ", " CDEM_COMPILER;
}

} // namespace cdem::app
