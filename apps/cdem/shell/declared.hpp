// What the command line declares, as completion and manual pages need it. Nothing is written down twice: both follow the
// declaration of each command and option.
#pragma once

#include "apps/cdem/command_line/command.hpp"

#include <string>
#include <vector>

namespace cdem::app {

struct DeclaredOption {
  std::vector<std::string> names; // "-o", "--output"
  std::string value;              // "DIR"; empty: a flag
  std::string text;               // what it does
  bool takes_folder = false, takes_file = false;
};

struct DeclaredCommand {
  std::string name, text;
  std::vector<DeclaredOption> options;
  std::string argument, argument_text; // "FILE"; empty: none
  std::vector<std::string> endings;    // of the files it takes, ".lua"; empty: any
  bool takes_folder = false, takes_command = false;
  std::string footer; // examples and notes, as its help prints them
};

struct Declared {
  DeclaredCommand program; // its options are those before a command
  std::vector<DeclaredCommand> commands;
};

// Without hidden options. program: the options before a command.
Declared declared(const Command& program, const std::vector<Command>& commands);

} // namespace cdem::app
