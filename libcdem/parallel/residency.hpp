// Which pages of large arrays stand in memory. An array keeps its length and its addresses; the pages of it that nobody
// needs are given back to the system, and read as zeros, or as what a file holds in their place, until they are written
// again.
#pragma once

#include "libcdem/parallel/chunks.hpp"

#include <cstddef>
#include <vector>

namespace cdem {

// Gives back the whole pages of [data, data + bytes) outside `kept` (ranges of bytes, ascending, that do not overlap).
// They are zeros from then on, and small pages (4 KiB): a large one would come back whole for the first byte written.
void release_outside(void* data, std::size_t bytes, const std::vector<Range>& kept);

// The same by entries.
template <class T>
void release_outside(std::vector<T>& array, std::vector<Range> kept) {
  for (Range& range : kept) {
    range.begin *= static_cast<std::int64_t>(sizeof(T));
    range.end *= static_cast<std::int64_t>(sizeof(T));
  }
  release_outside(array.data(), array.size() * sizeof(T), kept);
}

// Gives back pages that hold zeros only: no value changes.
void release_zeros(void* data, std::size_t bytes);

template <class T>
void release_zeros(std::vector<T>& array) {
  release_zeros(array.data(), array.size() * sizeof(T));
}

// Bytes of this process in memory now, and the most there have been: all, and of those what no file holds.
struct Resident {
  std::size_t all = 0, anonymous = 0, most = 0;
};
Resident resident();

// What was freed goes back to the system.
void trim_heap();

} // namespace cdem
