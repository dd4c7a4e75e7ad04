#include "libcdem/parallel/residency.hpp"

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

std::uintptr_t page_size() {
  static const auto size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  return size;
}

// The whole pages of it.
struct Pages {
  std::uintptr_t begin = 0, end = 0;

  Pages(const void* data, std::int64_t from, std::int64_t to) {
    const auto first = reinterpret_cast<std::uintptr_t>(data) + static_cast<std::uintptr_t>(from),
               last = reinterpret_cast<std::uintptr_t>(data) + static_cast<std::uintptr_t>(to),
               page = page_size();
    begin = (first + page - 1) / page * page;
    end = std::max(begin, last / page * page);
  }
};

void release(std::uintptr_t begin, std::uintptr_t end) {
  if (begin >= end)
    return;
  void* const pages = reinterpret_cast<void*>(begin); // NOLINT(performance-no-int-to-ptr): whole pages
  (void)madvise(pages, end - begin, MADV_NOHUGEPAGE);
  (void)madvise(pages, end - begin, MADV_DONTNEED);
}

} // namespace

void release_outside(void* data, std::size_t bytes, const std::vector<Range>& kept) {
  std::int64_t begin = 0;
  const auto give_back = [&](std::int64_t end) {
    const Pages pages(data, begin, end);
    release(pages.begin, pages.end);
  };
  for (const Range& range : kept) {
    give_back(range.begin);
    begin = range.end;
  }
  give_back(static_cast<std::int64_t>(bytes));
}

void release_zeros(void* data, std::size_t bytes) {
  const Pages all(data, 0, static_cast<std::int64_t>(bytes));
  const std::uintptr_t page = page_size();
  std::uintptr_t first = all.begin; // of a run of zeros
  for (std::uintptr_t at = all.begin; at < all.end; at += page) {
    const char* const here = reinterpret_cast<const char*>(at); // NOLINT(performance-no-int-to-ptr)
    if (here[0] == 0 && std::memcmp(here, here + 1, page - 1) == 0)
      continue;
    release(first, at);
    first = at + page;
  }
  release(first, all.end);
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
