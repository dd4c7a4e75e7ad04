// Values of options, checked: each throws UsageError with option, value and what is allowed.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace cdem::app {

int whole_number(const std::string& option, const std::string& text, int low, int high);
double real_number(const std::string& option, const std::string& text);

// {"pressure=24e6", ...} -> {pressure: 24e6}
std::map<std::string, std::string> settings_of(const std::vector<std::string>& texts);

// {"a=1,2,3", "b=x"} -> every combination, the last name changing fastest.
std::vector<std::map<std::string, std::string>> combinations_of(const std::vector<std::string>& texts);

std::array<int, 2> size_value(const std::string& option, const std::string& text);        // 1600x1200, 1600
std::vector<std::string> names_value(const std::string& option, const std::string& text); // floor,2,wall
std::array<double, 2> range_value(const std::string& option, const std::string& text);    // low,high

} // namespace cdem::app
