#include "lua/binding/runtime/csv.hpp"

namespace cdem::script {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  const auto last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos && text == trimmed(text))
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  if (trimmed(line).empty())
    return cells;
  std::string cell, kept; // kept: what stood in quotes
  bool inside = false, was_quoted = false;
  const auto end_cell = [&] {
    cells.push_back(was_quoted ? kept : trimmed(cell));
    cell.clear();
    kept.clear();
    was_quoted = false;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (inside) {
      if (c != '"')
        kept += c;
      else if (i + 1 < line.size() && line[i + 1] == '"')
        kept += line[++i];
      else
        inside = false;
    } else if (c == '"' && trimmed(cell).empty()) {
      inside = was_quoted = true;
    } else if (c == ',') {
      end_cell();
    } else {
      cell += c;
    }
  }
  end_cell();
  return cells;
}

} // namespace cdem::script
