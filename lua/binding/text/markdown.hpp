#pragma once

#include <string>

namespace cdem::script {

// A text as it stands in a cell of a table.
inline std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '|')
      out += "\\|";
    else
      out += c == '\n' ? ' ' : c;
  return out;
}

} // namespace cdem::script
