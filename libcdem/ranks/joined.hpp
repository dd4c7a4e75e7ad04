// Lists of the ranks put one behind the other, in the order of the ranks.
#pragma once

#include "libcdem/ranks/ranks.hpp"

#include <cstring>
#include <type_traits>

namespace cdem {

template <class T>
std::string bytes_of(const std::vector<T>& list) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)};
}

template <class T>
std::vector<T> joined_texts(const std::vector<std::string>& of_ranks) {
  std::vector<T> all;
  for (const std::string& text : of_ranks) {
    const std::size_t before = all.size();
    all.resize(before + text.size() / sizeof(T));
    std::memcpy(static_cast<void*>(all.data() + before), text.data(), text.size());
  }
  return all;
}

// All ranks call these together: all get all, or rank 0 does and the others get nothing.
template <class T>
std::vector<T> joined(const std::vector<T>& own) {
  return joined_texts<T>(ranks().gather(bytes_of(own)));
}
template <class T>
std::vector<T> joined_on_lead(const std::vector<T>& own) {
  std::vector<std::string> to(static_cast<std::size_t>(ranks().size()));
  to[0] = bytes_of(own);
  const std::vector<std::string> heard = ranks().deal(to);
  return ranks().leads() ? joined_texts<T>(heard) : std::vector<T>();
}

} // namespace cdem
