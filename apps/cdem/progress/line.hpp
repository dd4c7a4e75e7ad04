// Progress as text: one line, as rich as the width allows.
#pragma once

#include "apps/cdem/progress/time_left.hpp"
#include "libcdem/step/observer.hpp"

#include <string>

namespace cdem::app {

// For a terminal: never wider than `columns`; what matters least goes first when room is short.
std::string live_line(const Progress&, const TimeLeft&, int columns);

// For a file or a pipe.
std::string plain_line(const Progress&, const TimeLeft&);

// "1,204 broken (4 tension, 1,200 shear)"
std::string broken_text(std::int64_t tension, std::int64_t shear);

// Once a stage has ended.
std::string stage_line(const Progress&);

} // namespace cdem::app
