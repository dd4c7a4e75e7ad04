#include "libgeom/core/text_table.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace geom {
namespace {

constexpr std::size_t longest_shown = 40;
constexpr const char* no_break_space = "\xc2\xa0";

// Without blanks at its ends; spreadsheets also write the space of UTF-8 that breaks no line.
std::string without_blanks(std::string text) {
  for (auto at = text.find(no_break_space); at != std::string::npos; at = text.find(no_break_space, at))
    text.replace(at, 2, " ");
  const auto first = text.find_first_not_of(" \t\r\v\f"), last = text.find_last_not_of(" \t\r\v\f");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// What two spellings of a name have in common.
std::string key_of(const std::string& name) {
  std::string key;
  for (const char c : name)
    if (c != ' ' && c != '_' && c != '-')
      key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return key;
}

std::string shown(const std::string& cell) {
  std::string text = '"' + cell.substr(0, longest_shown) + (cell.size() > longest_shown ? "..." : "") + '"';
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ')
      c = ' ';
  return text;
}

std::size_t count_of(const std::string& text, char c) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), c));
}

bool is_empty(const std::vector<std::string>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); });
}

enum class Mark { none, decimal, either, thousands, no_number };

// What a comma or point in a number can mean: "0,5" decimal, "1,234" either, "1,234,567" thousands.
Mark meaning(const std::string& cell, char mark) {
  if (count_of(cell, mark) == 0)
    return Mark::none;
  std::string with_point = cell;
  if (count_of(cell, mark) == 1) {
    std::replace(with_point.begin(), with_point.end(), mark, '.');
    if (count_of(with_point, '.') > 1) // "1.234,5"
      return Mark::thousands;
    if (!plain_number(with_point))
      return Mark::no_number;
    const std::size_t sign = cell[0] == '-' || cell[0] == '+' ? 1 : 0, at = cell.find(mark) - sign;
    const bool three = cell.size() == sign + at + 4 && at >= 1 && at <= 3 && cell[sign] != '0';
    return three ? Mark::either : Mark::decimal;
  }
  with_point.erase(std::remove(with_point.begin(), with_point.end(), mark), with_point.end());
  return plain_number(with_point) ? Mark::thousands : Mark::no_number;
}

} // namespace

std::optional<double> plain_number(const std::string& text) {
  const char* const end = text.data() + text.size();
  const char* begin = text.data();
  if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-')
    ++begin;
  double x = 0;
  const auto [stop, error] = std::from_chars(begin, end, x);
  if (begin == end || error != std::errc() || stop != end)
    return std::nullopt;
  return x;
}

TextTable::TextTable(const std::string& text, const std::string& file) : file_(file) {
  if (text.rfind("\xff\xfe", 0) == 0 || text.rfind("\xfe\xff", 0) == 0)
    refuse("is written in UTF-16; save it as CSV in UTF-8");
  if (text.find('\0') != std::string::npos)
    refuse("holds bytes that are no text; save it as CSV in UTF-8");
  split(text.rfind("\xef\xbb\xbf", 0) == 0 ? text.substr(3) : text);
  if (rows_.empty())
    refuse("is empty; must hold rows of values");
  take_names();
  make_even();
  find_decimal_mark();
}

// Rows and cells, by a machine of one state: within quotes or not.
void TextTable::split(const std::string& text) {
  bool separator_known = false;
  std::size_t at = 0;
  int line = 1;
  if (text.rfind("sep=", 0) == 0 && text.size() > 4) { // Excel
    separator_ = text[4];
    separator_known = true;
    at = std::min(text.find('\n'), text.size() - 1) + 1;
    ++line;
  }
  const auto first_separator = [&](std::size_t from) {
    bool quoted = false;
    std::string row;
    for (std::size_t i = from; i < text.size() && (quoted || (text[i] != '\n' && text[i] != '\r')); ++i) {
      quoted = quoted != (text[i] == '"');
      row += quoted ? 'x' : text[i];
    }
    row = without_blanks(row);
    for (const char c : {'\t', ';', ','})
      if (row.find(c) != std::string::npos)
        return c;
    // Blanks part cells where the second row has them too: a name may hold some.
    const std::size_t next =
        std::min(text.find_first_not_of("\r\n", text.find_first_of("\r\n", from)), text.size());
    const std::string second =
        next < text.size() ? text.substr(next, text.find_first_of("\r\n", next) - next) : row;
    return row.find(' ') != std::string::npos && without_blanks(second).find(' ') != std::string::npos ? ' '
                                                                                                       : ',';
  };
  while (at < text.size()) {
    const auto first = text.find_first_not_of(" \t", at);
    if (first == std::string::npos)
      break;
    const std::size_t line_end = std::min(text.find_first_of("\r\n", at), text.size());
    const auto pass_end = [&] {
      if (at < text.size())
        at += text[at] == '\r' && at + 1 < text.size() && text[at + 1] == '\n' ? 2 : 1;
      ++line;
    };
    if (text[first] == '#' || first >= line_end) {
      at = line_end;
      pass_end();
      continue;
    }
    if (!separator_known)
      separator_ = first_separator(at);
    separator_known = true;
    Row row;
    row.line = line;
    std::string cell, kept;
    bool was_quoted = false;
    const auto end_cell = [&] {
      row.cells.push_back(was_quoted ? without_blanks(kept) : without_blanks(cell));
      cell.clear();
      kept.clear();
      was_quoted = false;
    };
    if (separator_ == ' ')
      at = first;
    for (; at < text.size() && text[at] != '\n' && text[at] != '\r'; ++at) {
      const char c = text[at];
      if (c == '"' && without_blanks(cell).empty() && !was_quoted) {
        was_quoted = true;
        const int opened = line;
        for (++at;; ++at) {
          if (at >= text.size())
            refuse("line " + std::to_string(opened) + ": a quote is opened and never closed");
          if (text[at] == '"' && (at + 1 >= text.size() || text[at + 1] != '"'))
            break;
          line += text[at] == '\n';
          kept += text[at];
          at += text[at] == '"'; // two are one
        }
      } else if (c == separator_) {
        end_cell();
        if (separator_ == ' ')
          at = std::min(text.find_first_not_of(' ', at), text.size()) - 1;
      } else {
        cell += c;
        if (was_quoted && c != ' ' && c != '\t')
          refuse("line " + std::to_string(line) + ": " + shown(std::string(1, c)) +
                 " stands behind a closed quote");
      }
    }
    end_cell();
    pass_end();
    if (!is_empty(row.cells))
      rows_.push_back(std::move(row));
  }
}

// The first row has names unless each of its cells is empty or a number.
void TextTable::take_names() {
  const auto numeric = [](const std::string& cell) {
    return cell.empty() || plain_number(cell) || meaning(cell, ',') == Mark::decimal ||
           meaning(cell, ',') == Mark::either;
  };
  if (std::all_of(rows_[0].cells.begin(), rows_[0].cells.end(), numeric))
    return;
  names_ = std::move(rows_[0].cells);
  rows_.erase(rows_.begin());
}

// Empty cells behind the last column go; every row must then be as wide as the first.
void TextTable::make_even() {
  const auto without_last = [](std::vector<std::string>& cells, std::size_t least) {
    while (cells.size() > least && cells.back().empty())
      cells.pop_back();
  };
  const bool named = !names_.empty();
  if (named)
    without_last(names_, 1);
  width_ = names_.size();
  if (!named) {
    for (Row& row : rows_) {
      std::vector<std::string> cells = row.cells;
      without_last(cells, 1);
      width_ = std::max(width_, cells.size());
    }
    width_ = std::min(width_, rows_[0].cells.size());
  }
  const std::string separator = separator_ == '\t'  ? "tabs"
                                : separator_ == ' ' ? "blanks"
                                                    : '"' + std::string(1, separator_) + '"';
  for (Row& row : rows_) {
    without_last(row.cells, width_);
    if (row.cells.size() == width_)
      continue;
    refuse("line " + std::to_string(row.line) + " has " + counted(row.cells.size(), "value") + ": must be " +
           std::to_string(width_) + (named ? ", as many as there are names" : ", as in the first row") +
           "; cells are parted by " + separator +
           (separator_ == ',' && row.cells.size() > width_
                ? ", so numbers with a decimal comma need semicolons between cells"
                : ""));
  }
}

void TextTable::find_decimal_mark() {
  if (separator_ == ',')
    return;
  const std::pair<std::size_t, std::size_t> none{rows_.size(), 0};
  auto either = none, point = none;
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (std::size_t c = 0; c < width_; ++c) {
      const std::string& text = rows_[r].cells[c];
      switch (meaning(text, ',')) {
      case Mark::thousands:
        refuse(r, c, "a number without marks between thousands");
      case Mark::decimal:
        decimal_comma_ = true;
        break;
      case Mark::either:
        either = either == none ? std::pair(r, c) : either;
        break;
      default:
        if (meaning(text, '.') == Mark::either)
          point = point == none ? std::pair(r, c) : point;
      }
    }
  if (!decimal_comma_ && either != none)
    refuse(
        either.first, either.second,
        "a number that can mean one thing only: its comma may be a decimal mark or stand between thousands");
  if (decimal_comma_ && point != none)
    refuse(point.first, point.second,
           "a number that can mean one thing only: others here have a decimal comma, so its point may stand "
           "between thousands");
}

std::optional<std::size_t> TextTable::find(const std::string& name) const {
  for (const bool exact : {true, false}) {
    std::optional<std::size_t> found;
    for (std::size_t c = 0; c < names_.size(); ++c)
      if (exact ? names_[c] == name : key_of(names_[c]) == key_of(name)) {
        if (found)
          refuse("more than one column \"" + name + "\"");
        found = c;
      }
    if (found)
      return found;
  }
  return std::nullopt;
}

double TextTable::number(std::size_t row, std::size_t column) const {
  std::string text = rows_[row].cells[column];
  if (text.empty())
    return std::nan("");
  if (decimal_comma_)
    std::replace(text.begin(), text.end(), ',', '.');
  const auto x = plain_number(text);
  if (!x)
    refuse(row, column, "a number");
  return *x;
}

std::vector<double> TextTable::numbers(std::size_t column) const {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows_.size(); ++row)
    values.push_back(number(row, column));
  return values;
}

std::string TextTable::column_text(std::size_t column) const {
  return column < names_.size() && !names_[column].empty() ? shown(names_[column])
                                                           : std::to_string(column + 1);
}

void TextTable::refuse(const std::string& why) const {
  throw InputError("file \"" + file_ + "\": " + why);
}

void TextTable::refuse(std::size_t row, std::size_t column, const std::string& allowed) const {
  const std::string& text = rows_[row].cells[column];
  refuse("line " + std::to_string(rows_[row].line) + ", column " + column_text(column) + ": " +
         (text.empty() ? "an empty cell" : shown(text)) + ": must be " + allowed);
}

} // namespace geom
