#include "lua/binding/text/csv.hpp"

namespace cdem::script {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  const auto last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",;\"\r\n\t") == std::string::npos && text == trimmed(text))
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

} // namespace cdem::script
