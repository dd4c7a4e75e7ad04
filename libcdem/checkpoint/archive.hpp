// Values as bytes, for checkpoints and hashes: archive(a, x) writes x to a Writer, adds it to a Hasher, or reads it
// from a Reader. A struct goes member by member, as its CDEM_ARCHIVE names them, so that no padding is written.
#pragma once

#include "libcdem/checkpoint/xxh64.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"
#include "libcdem/results/one_way_energies.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/types.hpp"

#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace cdem {

class Writer {
public:
  static constexpr bool reading = false;
  void raw(const void* data, std::size_t bytes) { text_.append(static_cast<const char*>(data), bytes); }
  const std::string& text() const { return text_; }
  std::string take() { return std::move(text_); }

private:
  std::string text_;
};

class Hasher {
public:
  static constexpr bool reading = false;
  void raw(const void* data, std::size_t bytes) { sum_.add(data, bytes); }
  std::uint64_t value() const { return sum_.value(); }

private:
  Xxh64 sum_;
};

// Adds what has no memory elsewhere byte by byte, the gaps between members included: several times as fast. Values that
// differ give different sums; values that are equal may do so too.
class RawHasher : public Hasher {};

// What it reads has a checksum that holds; what does not fit was written by another version.
class Reader {
public:
  static constexpr bool reading = true;
  explicit Reader(std::string_view text) : text_(text) {}
  [[noreturn]] static void refuse() {
    throw geom::InputError("checkpoint: written by another version of cdem; go on with that one");
  }
  void raw(void* data, std::size_t bytes) {
    const std::string_view part = take(bytes);
    if (bytes > 0)
      std::memcpy(data, part.data(), bytes);
  }
  std::string_view take(std::size_t bytes) {
    if (bytes > text_.size())
      refuse();
    const std::string_view part = text_.substr(0, bytes);
    text_.remove_prefix(bytes);
    return part;
  }
  std::size_t left() const { return text_.size(); }

private:
  std::string_view text_;
};

// Types whose bytes are their value: no pointers, no padding.
template <class T>
struct Flat : std::bool_constant<(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) || std::is_enum_v<T>> {
};
template <>
struct Flat<Node> : std::true_type {};
template <>
struct Flat<Range> : std::true_type {};
template <>
struct Flat<OneWayEnergies> : std::true_type {};
template <class T, std::size_t n>
struct Flat<std::array<T, n>> : Flat<T> {};
template <class T, std::size_t n>
struct Flat<T[n]> : Flat<T> {};
template <int rows, int columns>
struct Flat<Eigen::Matrix<double, rows, columns>> : std::bool_constant<(rows > 0 && columns > 0)> {};

template <class A, class T>
std::enable_if_t<Flat<T>::value> archive(A& a, T& x) {
  a.raw(&x, sizeof x);
}

template <class A>
void archive(A& a, bool& x) {
  std::uint8_t byte = x ? 1 : 0;
  a.raw(&byte, 1);
  x = byte != 0;
}

template <class A>
std::size_t archive_size(A& a, std::size_t size) {
  auto n = static_cast<std::uint64_t>(size);
  a.raw(&n, sizeof n);
  if constexpr (A::reading)
    if (n > a.left())
      Reader::refuse();
  return static_cast<std::size_t>(n);
}

template <class A>
void archive(A& a, std::string& x) {
  const std::size_t n = archive_size(a, x.size());
  if constexpr (A::reading)
    x = std::string(a.take(n));
  else
    a.raw(x.data(), n);
}

// Declared first, so that they may hold each other.
template <class A, class T>
void archive(A& a, std::vector<T>& x);
template <class A, class T>
void archive(A& a, std::optional<T>& x);
template <class A, class K, class V>
void archive(A& a, std::map<K, V>& x);
template <class A, class P, class Q>
std::enable_if_t<!Flat<std::pair<P, Q>>::value> archive(A& a, std::pair<P, Q>& x) {
  archive(a, x.first);
  archive(a, x.second);
}

template <class A, class T>
void archive(A& a, std::vector<T>& x) {
  const std::size_t n = archive_size(a, x.size());
  if constexpr (A::reading) {
    if (Flat<T>::value && n > a.left() / sizeof(T))
      Reader::refuse();
    x.clear();
    x.resize(n);
  }
  if constexpr (Flat<T>::value || (std::is_same_v<A, RawHasher> && std::is_trivially_destructible_v<T>)) {
    if (n > 0)
      a.raw(x.data(), n * sizeof(T));
  } else {
    for (T& item : x)
      archive(a, item);
  }
}

template <class A, class T>
void archive(A& a, std::optional<T>& x) {
  bool given = x.has_value();
  archive(a, given);
  if constexpr (A::reading)
    x = given ? std::optional<T>(T()) : std::nullopt;
  if (given)
    archive(a, *x);
}

template <class A, class K, class V>
void archive(A& a, std::map<K, V>& x) {
  const std::size_t n = archive_size(a, x.size());
  if constexpr (A::reading) {
    x.clear();
    for (std::size_t i = 0; i < n; ++i) {
      std::pair<K, V> entry;
      archive(a, entry);
      x.insert(std::move(entry));
    }
  } else {
    for (auto& [key, value] : x) {
      K copy = key;
      archive(a, copy);
      archive(a, value);
    }
  }
}

// archive_all(a, x, y, z): one after the other.
template <class A, class... T>
void archive_all(A& a, T&... x) {
  (archive(a, x), ...);
}

// CDEM_ARCHIVE(Struct, all its members in order): a new member that is not named here fails to compile.
#define CDEM_ARCHIVE(Struct, ...)                                                                            \
  template <class A>                                                                                         \
  void archive(A& a, Struct& x) {                                                                            \
    auto& [__VA_ARGS__] = x;                                                                                 \
    archive_all(a, __VA_ARGS__);                                                                             \
  }

// Writers and hashers change nothing.
template <class A, class T>
void archive_const(A& a, const T& x) {
  static_assert(!A::reading);
  archive(a, const_cast<T&>(x));
}

} // namespace cdem
