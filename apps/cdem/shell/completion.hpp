// What completes `cdem run --th<TAB>` in bash and zsh.
#pragma once

#include "apps/cdem/shell/declared.hpp"

namespace cdem::app {

std::string bash_completion(const Declared&);
std::string zsh_completion(const Declared&);

} // namespace cdem::app
