// The text of convert.py, which is part of the program.
#pragma once

namespace cdem::app {

extern const char* const convert_script;

} // namespace cdem::app
