// A word in single quotes of a shell.
#pragma once

#include <string>

namespace cdem::app {

inline std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word)
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

} // namespace cdem::app
