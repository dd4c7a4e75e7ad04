// A command as it is declared: its words, its options and what they mean, without the library that reads them. What is
// typed lands in the texts and flags that the declaration names; a command's action turns these into its work.
#pragma once

#include "apps/cdem/process/exit_code.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cdem::app {

inline constexpr const char* help_text = "print this help and exit"; // of -h, --help, which all have

using Action = std::function<ExitCode()>;

struct TypedLine {
  std::vector<std::string> words; // behind the program
  std::string text;               // "cdem run case.lua", for the log
};

class Command {
public:
  enum class Kind { argument, value, values, flag };
  struct Option {
    Kind kind;
    std::string names; // "--output,-o"; the name of an argument
    std::string form;  // of the value, as help prints it: "DIR"
    std::string text;  // what it does
    std::string* value = nullptr;
    std::vector<std::string>* values = nullptr; // may be repeated
    bool* flag = nullptr;                       // of a value: whether it was typed at all; may be null
    bool hidden = false;                        // from help
  };

  Command(std::string its_name, std::string its_text)
      : name(std::move(its_name)), text(std::move(its_text)) {}

  void argument(const std::string& its_name, std::string& into, const std::string& its_text) {
    options.push_back({Kind::argument, its_name, "", its_text, &into});
  }
  void value(const std::string& names, std::string& into, const std::string& form,
             const std::string& its_text, bool* typed = nullptr) {
    options.push_back({Kind::value, names, form, its_text, &into, nullptr, typed});
  }
  void values(const std::string& names, std::vector<std::string>& into, const std::string& form,
              const std::string& its_text) {
    options.push_back({Kind::values, names, form, its_text, nullptr, &into});
  }
  void flag(const std::string& names, bool& into, const std::string& its_text) {
    options.push_back({Kind::flag, names, "", its_text, nullptr, nullptr, &into});
  }
  void hide_last() { options.back().hidden = true; }
  // Below the options of its help.
  std::string footer() const {
    return examples.empty() ? notes : "examples:\n" + examples + (notes.empty() ? notes : "\n" + notes);
  }

  std::string name, text;
  std::string examples, notes;                    // below the options, with their line ends
  std::vector<Option> options;                    // in the order of help
  std::function<Action(const TypedLine&)> action; // throws UsageError
};

// In the order of help.
Command run_command();
Command resume_command();
Command check_command();
Command sweep_command();
Command render_command();
Command view_command();
Command info_command();
Command convert_command();
Command repl_command();
Command annotations_command();

} // namespace cdem::app
