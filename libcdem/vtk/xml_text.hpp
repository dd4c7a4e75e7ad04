// Text inside XML, between tags or in an attribute's quotes.
#pragma once

#include <string>

namespace cdem {

inline std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text)
    switch (c) {
    case '&':
      out += "&amp;";
      break;
    case '<':
      out += "&lt;";
      break;
    case '>':
      out += "&gt;";
      break;
    case '"':
      out += "&quot;";
      break;
    case '\n': // a reader takes a break or tabulator in an attribute for a blank
      out += "&#10;";
      break;
    case '\t':
      out += "&#9;";
      break;
    default:
      out += c;
    }
  return out;
}

} // namespace cdem
