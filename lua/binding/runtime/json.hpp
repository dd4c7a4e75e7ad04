// The only place where JSON from a file is read. Whatever a reader does with a value goes as deep as the value is
// nested, and the stack has an end: so deep text is refused before it is parsed.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace cdem::script {

inline constexpr int deepest_json = 64; // ours nest 5 deep

struct TooDeepJson : nlohmann::ordered_json::exception {
  TooDeepJson() : exception(0, "it nests more than 64 deep") {}
};

// Throws nlohmann::ordered_json::exception.
inline nlohmann::ordered_json parse_json(const std::string& text) {
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
  return nlohmann::ordered_json::parse(text);
}

// "[json.exception.parse_error.101] parse error at ...": without the library's number.
inline std::string json_reason(const nlohmann::ordered_json::exception& error) {
  const std::string text = error.what();
  const auto end = text.rfind('[', 0) == 0 ? text.find("] ") : std::string::npos;
  return end == std::string::npos ? text : text.substr(end + 2);
}

} // namespace cdem::script
