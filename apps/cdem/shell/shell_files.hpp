// Manual pages and completion as files of a folder that is installed as share/.
#pragma once

#include "apps/cdem/shell/declared.hpp"

#include <filesystem>

namespace cdem::app {

// man/man1/*.1, bash-completion/completions/cdem and zsh/site-functions/_cdem below the folder. Throws
// script::FileError.
void write_shell_files(const Declared&, const std::filesystem::path& folder);

} // namespace cdem::app
