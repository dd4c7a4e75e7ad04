#include "libcdem/parallel/residency.hpp"

#include "libcdem/parallel/pages.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <malloc.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace cdem {
namespace {

// New pages take their place: those of a heap on which a file was once mapped (ranks/parked_model.cpp) would read as that
// file again, not as zeros. Where the system has none to give they stay as they are.
void release(const Pages& pages) {
  if (pages.size() == 0)
    return;
  if (mmap(pages.data(), pages.size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1,
           0) != MAP_FAILED)
    (void)madvise(pages.data(), pages.size(), MADV_NOHUGEPAGE);
}

} // namespace

void release_outside(void* data, std::size_t bytes, const std::vector<Range>& kept) {
  std::int64_t begin = 0;
  const auto give_back = [&](std::int64_t end) { release(Pages(data, begin, end)); };
  for (const Range& range : kept) {
    give_back(range.begin);
    begin = range.end;
  }
  give_back(static_cast<std::int64_t>(bytes));
}

void release_zeros(void* data, std::size_t bytes) {
  const Pages all(data, 0, static_cast<std::int64_t>(bytes));
  Pages zeros = all; // a run of them
  for (zeros.end = all.begin; zeros.end < all.end;) {
    const char* const here = all.data() + (zeros.end - all.begin);
    zeros.end += page_size();
    if (here[0] == 0 && std::memcmp(here, here + 1, page_size() - 1) == 0)
      continue;
    const std::uintptr_t next = zeros.end;
    zeros.end -= page_size();
    release(zeros);
    zeros.begin = zeros.end = next;
  }
  release(zeros);
}

Resident resident() {
  Resident r;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes)
      r.most = kilobytes << 10;
    else if (word == "VmRSS:" && status >> kilobytes)
      r.all = kilobytes << 10;
    else if (word == "RssAnon:" && status >> kilobytes)
      r.anonymous = kilobytes << 10;
  }
  return r;
}

void trim_heap() {
  malloc_trim(0);
}

} // namespace cdem
