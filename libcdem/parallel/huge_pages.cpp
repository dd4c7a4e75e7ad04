#include "libcdem/parallel/huge_pages.hpp"

#include "libcdem/parallel/pages.hpp"

#include <cstdint>
#include <sys/mman.h>

namespace cdem {

void ask_for_huge_pages(const void* first, std::size_t bytes) {
  constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
  const Pages pages(first, 0, static_cast<std::int64_t>(bytes), page);
  if (pages.size() == 0)
    return;
  constexpr int collapse = 25; // MADV_COLLAPSE, Linux 6.1: now rather than some time; older ones refuse it
  if (madvise(pages.data(), pages.size(), MADV_HUGEPAGE) == 0)
    (void)madvise(pages.data(), pages.size(), collapse);
}

} // namespace cdem
