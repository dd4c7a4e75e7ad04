#include "libcdem/parallel/huge_pages.hpp"

#include <cstdint>
#include <sys/mman.h>

namespace cdem {

void ask_for_huge_pages(const void* first, std::size_t bytes) {
  constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
  const auto address = reinterpret_cast<std::uintptr_t>(first);
  const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
  if (bytes < page || end <= begin)
    return;
  auto* const pages = static_cast<char*>(const_cast<void*>(first)) + (begin - address);
  constexpr int collapse = 25; // MADV_COLLAPSE, Linux 6.1: now rather than some time; older ones refuse it
  if (madvise(pages, end - begin, MADV_HUGEPAGE) == 0)
    (void)madvise(pages, end - begin, collapse);
}

} // namespace cdem
