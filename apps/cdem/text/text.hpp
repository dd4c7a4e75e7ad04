// Small text helpers of the command line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cdem::app {

std::string duration_text(double seconds);  // 0.4 s, 12 s, 3 min 05 s, 2 h 07 min, 3 d 4 h
std::string count_text(std::int64_t count); // 41600 -> 41,600
std::string number_text(double value);      // three digits: 3.2e-05
// Columns in which every cell is as wide as the widest of its column; two spaces before each row.
std::string table_text(const std::vector<std::vector<std::string>>& rows);

} // namespace cdem::app
