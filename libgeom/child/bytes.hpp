// Values as bytes, for the pipe from a child process. Each count is checked against the number of bytes, since a child
// that has read a forged file can be trusted no more than the file.
#pragma once

#include "libgeom/core/types.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace geom {

class Unpacker {
public:
  explicit Unpacker(std::string_view bytes) : left_(bytes) {}
  void raw(void* to, std::size_t bytes) {
    if (bytes > left_.size())
      refuse();
    if (bytes > 0)
      std::memcpy(to, left_.data(), bytes);
    left_.remove_prefix(bytes);
  }
  // How many entries follow, none of which is smaller than `smallest` bytes.
  std::size_t count(std::size_t smallest) {
    std::uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > left_.size() / smallest)
      refuse();
    return static_cast<std::size_t>(n);
  }
  void end() const {
    if (!left_.empty())
      refuse();
  }
  [[noreturn]] static void refuse() {
    throw std::runtime_error("a child process has sent something else than its result");
  }

private:
  std::string_view left_;
};

// Numbers and arrays of them.
template <class T, std::enable_if_t<std::is_trivially_copyable_v<T>, int> = 0>
void pack(std::string& out, const T& x) {
  out.append(reinterpret_cast<const char*>(&x), sizeof x);
}
template <class T, std::enable_if_t<std::is_trivially_copyable_v<T>, int> = 0>
void unpack(Unpacker& in, T& x) {
  in.raw(&x, sizeof x);
}

// Vec3 and Mat3: Eigen's types are plain numbers, whatever the language says of them.
template <int Rows, int Columns>
void pack(std::string& out, const Eigen::Matrix<double, Rows, Columns>& x) {
  out.append(reinterpret_cast<const char*>(x.data()), sizeof(double) * Rows * Columns);
}
template <int Rows, int Columns>
void unpack(Unpacker& in, Eigen::Matrix<double, Rows, Columns>& x) {
  in.raw(x.data(), sizeof(double) * Rows * Columns);
}

inline void pack(std::string& out, const std::string& x) {
  pack(out, static_cast<std::uint64_t>(x.size()));
  out += x;
}
inline void unpack(Unpacker& in, std::string& x) {
  x.resize(in.count(1));
  in.raw(x.data(), x.size());
}

template <class T>
void pack(std::string& out, const std::vector<T>& all) {
  pack(out, static_cast<std::uint64_t>(all.size()));
  for (const T& x : all)
    pack(out, x);
}
template <class T>
void unpack(Unpacker& in, std::vector<T>& all) {
  constexpr std::size_t least = 4; // an int; anything else takes more
  all.resize(in.count(least));
  for (T& x : all)
    unpack(in, x);
}

inline void pack(std::string& out, const Box& x) {
  pack(out, x.min);
  pack(out, x.max);
}
inline void unpack(Unpacker& in, Box& x) {
  unpack(in, x.min);
  unpack(in, x.max);
}

} // namespace geom
