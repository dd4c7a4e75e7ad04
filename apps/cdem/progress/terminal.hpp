// The terminal behind stdout.
#pragma once

#include <string>

namespace cdem::app {

bool is_live_terminal(); // stdout is a terminal that can move its cursor
int terminal_columns();
int terminal_rows();

// "[=====>    ]", `width` between the brackets; fraction in 0 to 1.
std::string bar_text(double fraction, int width);

} // namespace cdem::app
