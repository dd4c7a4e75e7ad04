// Checks of what was read: each throws InputError that names the field.
#pragma once

#include "libcdem/model/model.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace cdem::whole {

[[noreturn]] inline void refuse(const std::string& field, const std::string& what) {
  throw geom::InputError("the saved model is not whole: " + field + ": " + what +
                         "; the file was changed, or written by another version of cdem");
}

inline void require_length(const std::string& field, std::size_t length, std::size_t wanted) {
  if (length != wanted)
    refuse(field, std::to_string(length) + " entries where there must be " + std::to_string(wanted));
}

inline void require(bool holds, const char* field, std::int64_t value) {
  if (!holds)
    refuse(field, std::to_string(value) + " is out of range");
}

// 0 <= index < end; from -1 where none is meant by that.
inline void below(const char* field, std::int64_t index, std::size_t end, std::int64_t first = 0) {
  require(index >= first && index < static_cast<std::int64_t>(end), field, index);
}

template <class List>
void all_below(const char* field, const List& list, std::size_t end, std::int64_t first = 0) {
  for (const auto index : list)
    below(field, index, end, first);
}

// begin <= end within an array of `length` entries.
inline void within(const char* field, std::int64_t begin, std::int64_t end, std::size_t length) {
  require(begin >= 0 && begin <= end, field, begin);
  require(end <= static_cast<std::int64_t>(length), field, end);
}
inline void within(const char* field, const Range& range, std::size_t length) {
  within(field, range.begin, range.end, length);
}

// Starts at 0, never falls, ends at `last`: (n + 1) entries that part an array.
template <class List>
void require_parts(const char* field, const List& begin, std::size_t parts, std::size_t last) {
  require_length(field, begin.size(), parts + 1);
  require(begin.front() == 0, field, begin.front());
  require(std::is_sorted(begin.begin(), begin.end()), field, begin.front());
  require(static_cast<std::size_t>(begin.back()) == last, field, begin.back());
}

// Ranges that follow each other from `first` to `last` without a gap.
class Follow {
public:
  Follow(const char* field, std::int64_t first) : field_(field), next_(first) {}
  void operator()(std::int64_t begin, std::int64_t end) {
    require(begin == next_ && end >= begin, field_, begin);
    next_ = end;
  }
  void operator()(const Range& range) { (*this)(range.begin, range.end); }
  void end_at(std::int64_t last) const { require(next_ == last, field_, next_); }

private:
  const char* field_;
  std::int64_t next_;
};

inline std::int64_t count(std::size_t n) {
  return static_cast<std::int64_t>(n);
}

template <class Pairs>
void check_pairs(const char* field, const Pairs& pairs, const Model& model) {
  for (const auto& [bodies, joint] : pairs) {
    below(field, bodies.first, model.bodies.size());
    below(field, bodies.second, model.bodies.size());
    below(field, joint, model.joints.size());
  }
}

// The parts of a Model, one a file.
void check_mesh(const Model&);
void check_surface(const Model&);

} // namespace cdem::whole
