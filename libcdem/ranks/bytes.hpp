// Values and vectors of values as bytes, one behind the other, as ranks of one program tell them to each other.
#pragma once

#include <cstring>
#include <string>
#include <vector>

namespace cdem {

class Pack {
public:
  template <class T>
  void operator()(const T& value) {
    bytes(&value, sizeof value);
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    (*this)(values.size());
    bytes(values.data(), values.size() * sizeof(T));
  }
  void bytes(const void* from, std::size_t count) { text_.append(static_cast<const char*>(from), count); }

  const std::string& text() const { return text_; }

private:
  std::string text_;
};

// Reads the same in the same order. The text must live as long.
class Unpack {
public:
  explicit Unpack(const std::string& from) : at_(from.data()) {}

  template <class T>
  void operator()(T& value) {
    bytes(reinterpret_cast<char*>(&value), sizeof value);
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    std::size_t count = 0;
    (*this)(count);
    values.assign(count, T());
    bytes(reinterpret_cast<char*>(values.data()), count * sizeof(T));
  }
  void bytes(char* to, std::size_t count) {
    std::memcpy(to, at_, count);
    at_ += count;
  }

private:
  const char* at_;
};

} // namespace cdem
