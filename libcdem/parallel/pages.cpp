#include "libcdem/parallel/pages.hpp"

#include <unistd.h>

namespace cdem {

std::uintptr_t page_size() {
  static const auto size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  return size;
}

} // namespace cdem
