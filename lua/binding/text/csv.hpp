// Tables as text, RFC 4180: cells between commas. A cell with a comma, semicolon, tab, quote or break stands in quotes, and
// quotes in it are doubled. libgeom/core/text_table reads tables.
#pragma once

#include <string>

namespace cdem::script {

// Without blanks, tabs and carriage returns at its ends.
std::string trimmed(const std::string& text);

std::string csv_cell(const std::string& text);

} // namespace cdem::script
