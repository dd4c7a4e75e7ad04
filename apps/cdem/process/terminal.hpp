// The terminal behind stdout.
#pragma once

#include <string>

namespace cdem::app {

bool is_live_terminal(); // stdout is a terminal that can move its cursor
int terminal_columns();

// A line for stderr whose word ("error:", "warning:") is in colour where stdout and stderr are terminals and NO_COLOR is
// unset or empty (https://no-color.org).
enum class Tone { error, warning };
std::string with_tone(const std::string& line, Tone tone);
int terminal_rows();

// "[=====>    ]", `width` between the brackets; fraction in 0 to 1.
std::string bar_text(double fraction, int width);

} // namespace cdem::app
