// cdem(1), cdem-run(1), ...: the help of the program and of each command as manual pages.
#pragma once

#include "apps/cdem/shell/declared.hpp"

#include <map>

namespace cdem::app {

std::map<std::string, std::string> manual_pages(const Declared&); // by file: "cdem-run.1"

} // namespace cdem::app
