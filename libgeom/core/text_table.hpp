// A table in a text file, as spreadsheets and loggers write it.
//
// - Cells stand between tabs, semicolons, commas or blanks: the first of these that its first row holds outside quotes.
//   Excel's line "sep=;" is obeyed. Quotes follow RFC 4180.
// - A mark of UTF-8, ends of lines of any system, empty rows, rows that begin with #, empty cells behind the last
//   column and blanks around cells mean nothing.
// - A decimal comma is read where commas part no cells and no number can mean two things.
// - Names of columns are found without regard to capitals, blanks, `_` and `-`, if no other name is equal then.
//
// What remains ambiguous is refused with its line and column.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace geom {

class TextTable {
public:
  // `file` is the name in messages. Throws InputError.
  TextTable(const std::string& text, const std::string& file);

  const std::vector<std::string>& names() const { return names_; } // of the columns; none: the file has none
  std::size_t columns() const { return width_; }
  std::size_t rows() const { return rows_.size(); }
  int line(std::size_t row) const { return rows_[row].line; } // in the file, from 1
  const std::string& cell(std::size_t row, std::size_t column) const { return rows_[row].cells[column]; }

  // Nothing where no column has the name; throws where several have it.
  std::optional<std::size_t> find(const std::string& name) const;

  // nan for an empty cell; throws where a cell is no number.
  double number(std::size_t row, std::size_t column) const;
  std::vector<double> numbers(std::size_t column) const;

  std::string column_text(std::size_t column) const; // as messages name it
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& allowed) const;

private:
  struct Row {
    int line = 0;
    std::vector<std::string> cells;
  };
  void split(const std::string& text);
  void take_names();
  void make_even();
  void find_decimal_mark();

  std::string file_;
  char separator_ = ',';
  bool decimal_comma_ = false;
  std::size_t width_ = 0;
  std::vector<std::string> names_;
  std::vector<Row> rows_;
};

// A number as people write it, with a decimal point: "+0.1", ".5", "1e-3". Nothing for anything else.
std::optional<double> plain_number(const std::string& text);

} // namespace geom
