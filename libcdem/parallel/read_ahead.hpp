// Memory that is wanted soon, asked for a little at a time between pieces of other work: a processor that computes on
// what its near cache holds has its memory idle, and would wait for the next piece once it gets there.
#pragma once

#include "libcdem/parallel/node.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace cdem {

class ReadAhead {
public:
  // `count` entries; hints only, an array may be empty or end earlier.
  template <class T>
  void add(const T* first, std::int64_t count) {
    add({reinterpret_cast<const char*>(first), nullptr, 0,
         (count * std::int64_t{sizeof(T)} + line - 1) / line});
  }
  // Those at `count` places of an array.
  template <class T>
  void add_at(const T* array, const int* places, std::int64_t count) {
    add({reinterpret_cast<const char*>(array), places, sizeof(T), count});
  }
  // Spreads what was added over so many calls of some().
  void spread(std::int64_t calls) { each_ = calls > 0 ? (lines_ + calls - 1) / calls : 0; }

  CDEM_INLINE void some() {
    for (std::int64_t left = each_; left > 0 && next_ < used_;) {
      Stream& stream = streams_[next_];
      const std::int64_t n = std::min(left, stream.lines);
      if (stream.places) {
        for (std::int64_t i = 0; i < n; ++i)
          __builtin_prefetch(stream.at + stream.places[i] * stream.size, 0, 2);
        stream.places += n;
      } else {
        for (std::int64_t i = 0; i < n; ++i)
          __builtin_prefetch(stream.at + i * line, 0, 2); // into the second cache
        stream.at += n * line;
      }
      stream.lines -= n;
      left -= n;
      next_ += stream.lines == 0 ? 1 : 0;
    }
  }

private:
  static constexpr int most = 12;
  static constexpr std::int64_t line = 64;
  struct Stream {
    const char* at = nullptr;
    const int* places = nullptr; // null: lines one after the other
    std::int64_t size = 0;       // of an entry, where there are places
    std::int64_t lines = 0;
  };
  void add(const Stream& stream) {
    if (stream.lines <= 0 || used_ == most)
      return;
    streams_[used_++] = stream;
    lines_ += stream.lines;
  }
  Stream streams_[most];
  int used_ = 0, next_ = 0;
  std::int64_t lines_ = 0, each_ = 0;
};

} // namespace cdem
