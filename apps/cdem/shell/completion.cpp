#include "apps/cdem/shell/completion.hpp"

#include "apps/cdem/text/quoted.hpp"

#include <functional>

namespace cdem::app {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : between) + word;
  return text;
}

std::string names(const DeclaredCommand& command, const std::function<bool(const DeclaredOption&)>& wanted) {
  std::vector<std::string> all;
  for (const DeclaredOption& option : command.options)
    if (wanted(option))
      all.insert(all.end(), option.names.begin(), option.names.end());
  return joined(all, " ");
}

std::string command_names(const Declared& all) {
  std::vector<std::string> words;
  for (const DeclaredCommand& command : all.commands)
    words.push_back(command.name);
  return joined(words, " ");
}

// As quoted(), for a part of a specification of _arguments, where : and [] have a meaning.
std::string in_specification(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += (c == ':' || c == '[' || c == ']' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out;
}

std::string zsh_files(const std::vector<std::string>& endings) {
  if (endings.empty())
    return "_files";
  std::vector<std::string> words;
  words.reserve(endings.size());
  for (const std::string& ending : endings)
    words.push_back(ending.substr(1));
  return "_files -g \"*.(" + joined(words, "|") + ")\"";
}

std::string zsh_option(const DeclaredOption& option) {
  const std::string action = option.takes_folder ? "_files -/" : option.takes_file ? "_files" : " ";
  const std::string rest =
      "[" + in_specification(option.text) + "]" +
      (option.value.empty() ? std::string() : ":" + in_specification(option.value) + ":" + action);
  std::string text;
  for (const std::string& name : option.names) // each may come again: --set does
    text += " " + quoted("*" + name + rest);
  return text;
}

std::string zsh_arguments(const DeclaredCommand& command, const std::string& commands) {
  std::string text = "_arguments";
  for (const DeclaredOption& option : command.options)
    text += zsh_option(option);
  if (command.takes_command)
    text += " " + quoted("1:command:(" + commands + ")");
  else if (!command.argument.empty())
    text += " " + quoted("1:" + in_specification(command.argument_text) + ":" +
                         (command.takes_folder && command.endings.empty() ? "_files -/"
                                                                          : zsh_files(command.endings)));
  return text;
}

} // namespace

std::string bash_completion(const Declared& all) {
  const auto any = [](const DeclaredOption&) { return true; };
  const std::string first = command_names(all) + " " + names(all.program, any);
  std::string text =
      "# bash completion of cdem, made by the program from its command line.\n"
      "_cdem() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command='' i\n"
      "  local options='' values='' folders='' files='' endings='' words='' folder=false\n"
      "  COMPREPLY=()\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    if [[ ${COMP_WORDS[i]} != -* ]]; then command=${COMP_WORDS[i]}; break; fi\n"
      "  done\n"
      "  case $command in\n"
      "    '') words=" +
      quoted(first) + " ;;\n";
  for (const DeclaredCommand& command : all.commands) {
    text +=
        "    " + command.name + ")\n      options=" + quoted(names(command, any)) +
        "\n      values=" + quoted(names(command, [](const DeclaredOption& o) { return !o.value.empty(); })) +
        "\n      folders=" + quoted(names(command, [](const DeclaredOption& o) { return o.takes_folder; })) +
        "\n      files=" + quoted(names(command, [](const DeclaredOption& o) { return o.takes_file; })) +
        "\n      endings=" + quoted(joined(command.endings, " ")) +
        " folder=" + (command.takes_folder ? "true" : "false") +
        " words=" + quoted(command.takes_command ? command_names(all) : "") + "\n      ;;\n";
  }
  return text + "  esac\n"
                "  local IFS=$'\\n'\n"
                "  if [[ \" $folders \" == *\" $before \"* ]]; then\n"
                "    COMPREPLY=($(compgen -d -- \"$word\"))\n"
                "  elif [[ \" $files \" == *\" $before \"* ]]; then\n"
                "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
                "  elif [[ \" $values \" == *\" $before \"* ]]; then\n"
                "    COMPREPLY=()\n"
                "  elif [[ -n $words && ( $word != -* || -z $options ) ]]; then\n"
                "    COMPREPLY=($(compgen -W \"${words// /$'\\n'}\" -- \"$word\"))\n"
                "  elif [[ $word == -* ]]; then\n"
                "    COMPREPLY=($(compgen -W \"${options// /$'\\n'}\" -- \"$word\"))\n"
                "  elif [[ -n $endings ]]; then\n"
                "    COMPREPLY=($(compgen -d -- \"$word\"))\n"
                "    local ending\n"
                "    IFS=' '\n"
                "    for ending in $endings; do\n"
                "      IFS=$'\\n'\n"
                "      COMPREPLY+=($(compgen -f -X \"!*$ending\" -- \"$word\"))\n"
                "    done\n"
                "  elif $folder; then\n"
                "    COMPREPLY=($(compgen -d -- \"$word\"))\n"
                "  fi\n"
                "}\n"
                "complete -o filenames -F _cdem cdem\n";
}

std::string zsh_completion(const Declared& all) {
  const std::string commands = command_names(all);
  std::string text = "#compdef cdem\n# zsh completion of cdem, made by the program from its command line.\n"
                     "_cdem() {\n  local context state state_descr line\n  typeset -A opt_args\n"
                     "  _arguments -C";
  for (const DeclaredOption& option : all.program.options)
    text += zsh_option(option);
  text += " '1:command:->command' '*::argument:->argument'\n"
          "  case $state in\n    command)\n      local -a commands\n      commands=(";
  for (const DeclaredCommand& command : all.commands)
    text += "\n        " + quoted(command.name + ":" + command.text);
  text += "\n      )\n      _describe command commands\n      ;;\n    argument)\n      case $words[1] in\n";
  for (const DeclaredCommand& command : all.commands)
    text += "        " + command.name + ") " + zsh_arguments(command, commands) + " ;;\n";
  return text + "      esac\n      ;;\n  esac\n}\n_cdem \"$@\"\n";
}

} // namespace cdem::app
