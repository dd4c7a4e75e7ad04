// Entries of arrays that one rank computes and others read, and that are sent in each step.
#pragma once

#include "libcdem/ranks/ranks.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace cdem {

class Links {
public:
  // needs: numbers of entries that this rank reads and others own; may name some twice, and its own. owner: of an entry.
  // All ranks make theirs together.
  void set(std::vector<std::int32_t> needs, const std::function<int(std::int64_t)>& owner);

  // An array with one entry for each number, all of one size.
  struct Array {
    void* data = nullptr;
    std::size_t bytes = 0; // of an entry
  };
  template <class T>
  static Array array(std::vector<T>& values) {
    return {values.data(), sizeof(T)};
  }
  // Afterwards the entries that this rank needs are those of their owners.
  void share(const std::vector<Array>& arrays);

  std::size_t received() const; // entries

private:
  std::vector<std::vector<std::int32_t>> send_, receive_; // per rank, ascending
  std::vector<std::vector<char>> sent_, received_;        // the same in bytes
};

} // namespace cdem
