// What the commands that run a script share.
#pragma once

#include "apps/cdem/commands/commands.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <memory>

namespace cdem::app {

// False where there is none; FileError where that cannot be known, say in a folder without permission.
bool is_there(const std::filesystem::path&);

// A script that is missing, a folder or unreadable: script::FileError, UsageError.
void require_script(const std::filesystem::path&);

int available_cores(); // this process may use

// Rows for a person: name, value, unit, range, what it is.
std::string parameter_table(const std::vector<script::ParameterInfo>&);

} // namespace cdem::app
