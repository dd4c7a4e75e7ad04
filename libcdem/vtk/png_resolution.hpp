// How large a PNG is printed: its chunk pHYs, which VTK's writer leaves out.
#pragma once

#include <string>

namespace cdem {

std::string with_resolution(const std::string& png, double dpi); // pixels in an inch

} // namespace cdem
