#include "apps/cdem/shell/declared.hpp"

#include <regex>
#include <sstream>

namespace cdem::app {
namespace {

bool is_folder(const std::string& value) {
  return value == "DIR" || value == "FOLDER";
}

bool is_file(const std::string& value) {
  return value.rfind("FILE", 0) == 0 || value == "PATH";
}

// "--output,-o": the short name first.
std::vector<std::string> names_in(const std::string& declared) {
  std::vector<std::string> shorts, longs;
  std::istringstream parts(declared);
  for (std::string name; std::getline(parts, name, ',');)
    (name.rfind("--", 0) == 0 ? longs : shorts).push_back(name);
  shorts.insert(shorts.end(), longs.begin(), longs.end());
  return shorts;
}

DeclaredOption option_of(const Command::Option& option) {
  DeclaredOption one;
  one.names = names_in(option.names);
  if (option.kind != Command::Kind::flag)
    one.value = option.form;
  one.text = option.text;
  one.takes_folder = is_folder(one.value);
  one.takes_file = is_file(one.value);
  return one;
}

// ".vtu", ".lua" of "a .vtu file, a .lua script or a folder".
std::vector<std::string> endings_in(const std::string& text) {
  static const std::regex ending("(^|[ *])(\\.[a-z0-9]+)\\b");
  std::vector<std::string> all;
  for (std::sregex_iterator at(text.begin(), text.end(), ending), end; at != end; ++at)
    all.push_back((*at)[2]);
  return all;
}

DeclaredCommand command_of(const Command& command) {
  DeclaredCommand one;
  one.name = command.name;
  one.text = command.text;
  one.footer = command.footer();
  for (const Command::Option& option : command.options) {
    if (option.hidden)
      continue;
    if (option.kind != Command::Kind::argument) {
      one.options.push_back(option_of(option));
      continue;
    }
    one.argument = option.names;
    one.argument_text = option.text;
    one.takes_command = one.argument.find("COMMAND") != std::string::npos;
    one.endings = endings_in(one.argument_text);
    one.takes_folder = one.argument_text.find("folder") != std::string::npos;
  }
  return one;
}

const DeclaredOption help{{"-h", "--help"}, "", help_text};

} // namespace

Declared declared(const Command& program, const std::vector<Command>& commands) {
  Declared all;
  all.program = command_of(program);
  all.program.options.insert(all.program.options.begin(), help);
  for (const Command& command : commands) {
    all.commands.push_back(command_of(command));
    all.commands.back().options.push_back(help);
  }
  return all;
}

} // namespace cdem::app
