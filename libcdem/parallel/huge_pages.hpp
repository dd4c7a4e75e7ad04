// Large arrays on pages of 2 MiB instead of 4 KiB: a step that walks through more memory than the caches hold spends
// part of its time in looking pages up. A request only: where the system has none to give nothing changes.
#pragma once

#include <cstddef>
#include <vector>

namespace cdem {

// The whole pages of 2 MiB in [first, first + bytes); contents stay as they are.
void ask_for_huge_pages(const void* first, std::size_t bytes);

template <class T>
void ask_for_huge_pages(const std::vector<T>& array) {
  ask_for_huge_pages(array.data(), array.size() * sizeof(T));
}

} // namespace cdem
