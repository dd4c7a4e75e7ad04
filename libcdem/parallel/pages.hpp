// Whole pages of memory in a range of addresses.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace cdem {

std::uintptr_t page_size(); // bytes

inline std::uintptr_t in_page(const void* address) { // bytes behind its begin
  return reinterpret_cast<std::uintptr_t>(address) % page_size();
}

// The whole pages within bytes [from, to) of an array at `data`; empty if there is none.
struct Pages {
  std::uintptr_t begin = 0, end = 0;

  Pages(const void* data, std::int64_t from, std::int64_t to, std::uintptr_t page = page_size()) {
    const auto first = reinterpret_cast<std::uintptr_t>(data) + static_cast<std::uintptr_t>(from),
               last = reinterpret_cast<std::uintptr_t>(data) + static_cast<std::uintptr_t>(to);
    begin = (first + page - 1) / page * page;
    end = std::max(begin, last / page * page);
  }
  std::size_t size() const { return end - begin; }
  // Whole pages have no other name than their address.
  char* data() const { return reinterpret_cast<char*>(begin); } // NOLINT(performance-no-int-to-ptr)
};

} // namespace cdem
