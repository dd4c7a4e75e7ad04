#include "apps/cdem/shell/declared.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <regex>

namespace cdem::app {
namespace {

bool is_folder(const std::string& value) {
  return value == "DIR" || value == "FOLDER";
}

bool is_file(const std::string& value) {
  return value.rfind("FILE", 0) == 0 || value == "PATH";
}

DeclaredOption option_of(const CLI::Option& option) {
  DeclaredOption one;
  for (const std::string& name : option.get_snames())
    one.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    one.names.push_back("--" + name);
  if (option.get_expected_min() > 0)
    one.value = option.get_option_text().empty() ? "VALUE" : option.get_option_text();
  one.text = option.get_description();
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

DeclaredCommand command_of(const CLI::App& app) {
  DeclaredCommand command;
  command.name = app.get_name();
  command.text = app.get_description();
  command.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty())
      continue;
    if (!option->get_positional()) {
      command.options.push_back(option_of(*option));
      continue;
    }
    command.argument = option->get_name(true);
    command.argument_text = option->get_description();
    command.takes_command = command.argument.find("COMMAND") != std::string::npos;
    command.endings = endings_in(command.argument_text);
    command.takes_folder = command.argument_text.find("folder") != std::string::npos;
  }
  return command;
}

} // namespace

Declared declared(const CLI::App& app) {
  Declared all;
  all.program = command_of(app);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty())
      all.commands.push_back(command_of(*command));
  return all;
}

} // namespace cdem::app
