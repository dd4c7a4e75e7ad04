// Tables as text, RFC 4180: cells between commas; one that holds a comma, a quote or a break stands in quotes, and quotes
// in it are doubled.
#pragma once

#include <string>
#include <vector>

namespace cdem::script {

// Without blanks, tabs and carriage returns at its ends.
std::string trimmed(const std::string& text);

std::string csv_cell(const std::string& text);

// The cells of one line, without blanks around those that are not in quotes.
std::vector<std::string> csv_cells(const std::string& line);

} // namespace cdem::script
