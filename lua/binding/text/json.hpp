// What is asked of JSON from a file before it is parsed. Whatever a reader does with a value goes as deep as the value is
// nested, and the stack has an end: so deep text is refused.
#pragma once

#include <stdexcept>
#include <string>

namespace cdem::script {

inline constexpr int deepest_json = 64; // ours nest 5 deep

struct TooDeepJson : std::runtime_error {
  TooDeepJson() : std::runtime_error("it nests more than 64 deep") {}
};

// The text. Throws TooDeepJson.
inline const std::string& shallow_json(const std::string& text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++depth > deepest_json)
      throw TooDeepJson();
    else if (!quoted && (c == ']' || c == '}'))
      --depth;
  }
  return text;
}

// "[json.exception.parse_error.101] parse error at ...": without the library's number.
inline std::string json_reason(const std::exception& error) {
  const std::string text = error.what();
  const auto end = text.rfind('[', 0) == 0 ? text.find("] ") : std::string::npos;
  return end == std::string::npos ? text : text.substr(end + 2);
}

} // namespace cdem::script
