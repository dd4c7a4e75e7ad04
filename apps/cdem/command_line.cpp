#include "apps/cdem/command_line.hpp"

#include "apps/cdem/command_line/command.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/shell/shell_files.hpp"
#include "lua/binding/text/nearest.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace cdem::app {

namespace {

// "Usage: cdem run [OPTIONS] FILE" and plain lower-case headings in a narrow column.
class HelpFormatter : public CLI::Formatter {
public:
  HelpFormatter() { column_width(30); }
  // One short and one long name: the American spellings work, and need no room here.
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    if (positional)
      return option->get_name(true);
    const auto &shorts = option->get_snames(), &longs = option->get_lnames();
    return (shorts.empty() ? "    " : "-" + shorts.front() + ", ") + "--" + longs.front();
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_option_text().empty() ? "" : " " + option->get_option_text();
  }
  std::string make_usage(const CLI::App* app, std::string) const override {
    std::string name = app->get_name();
    for (const auto* parent = app->get_parent(); parent != nullptr; parent = parent->get_parent())
      name = parent->get_name() + " " + name;
    std::string usage = "\nusage: " + name;
    if (!app->get_subcommands([](const CLI::App*) { return true; }).empty())
      return usage + " COMMAND [...]\n";
    for (const auto* option : app->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      usage += " " + option->get_name(true);
    return usage + " [OPTIONS]\n";
  }
};

class Parser {
public:
  Parser() : app_(program_.text, program_.name) {
    app_.formatter(std::make_shared<HelpFormatter>());
    app_.set_help_flag("-h,--help", help_text)->group("options");
    app_.allow_extras();
    app_.require_subcommand(0, 1);
    app_.get_formatter()->label("Positionals", "arguments");
    app_.option_defaults()->group("options");
    program_.flag("--version", version_, "print the version and exit");
    program_.flag("--manual", manual_, "print the help of every command as Markdown");
    program_.hide_last();
    program_.value("--shell-files", shell_files_, "DIR", "folder for manual pages and completion");
    program_.hide_last();
    program_.examples = "  cdem run examples/uniaxial_compression/case.lua\n"
                        "  cdem run case.lua --set pressure=24e6 --threads 2 --output results/gentle\n"
                        "  cdem resume results/gentle\n"
                        "  cdem check case.lua\n"
                        "  cdem sweep case.lua --set pressure=20e6,25e6,30e6 --jobs 2\n"
                        "  cdem render results/plate/result.vtu --colour displacement.x --deformation 20\n"
                        "  cdem view results/plate\n"
                        "  cdem help run\n";
    program_.notes =
        "environment:\n"
        "  CDEM_INSTRUCTION_SET        baseline, avx2 or avx512: what kernels run with (the widest that the\n"
        "                              processor has); results are the same bits for every one\n"
        "\n"
        "exit codes:\n" +
        exit_code_table();
    add_options(&app_, program_);
    app_.footer(program_.footer());
    Command help("help", "print the help of a command");
    help.argument("[COMMAND]", topic_, "run, check, ...");
    help.action = [this](const TypedLine&) { return help_action(); };
    commands_.push_back(help);
    for (const Command& command : commands_) {
      auto* app = app_.add_subcommand(command.name, command.text);
      app->group("commands");
      add_options(app, command);
      app->set_help_flag("-h,--help", help_text);
      app->allow_extras();
      app->footer(command.footer());
    }
  }

  std::function<ExitCode()> parse(int argc, const char* const* argv) {
    line_.words.assign(argv + std::min(1, argc), argv + argc);
    for (int i = 0; i < argc; ++i)
      line_.text += (i == 0 ? "cdem" : std::string(" ") + argv[i]);
    try {
      app_.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
      const auto chosen = app_.get_subcommands();
      return print(chosen.empty() ? help_of(&app_) : help_of(chosen.front()));
    } catch (const CLI::ArgumentMismatch& error) {
      const std::string text = error.what(); // "--threads: 1 required TEXT missing"
      throw UsageError(text.substr(0, text.find(':')) + ": its value is missing");
    } catch (const CLI::ParseError& error) {
      throw UsageError(error.what());
    }
    return action();
  }

  std::string manual() {
    std::string text = "# Command line\n\n"
                       "What `cdem --help` and `cdem help COMMAND` print. Exit codes are explained in\n"
                       "[exit-codes.md](exit-codes.md).\n";
    const auto add = [&](const std::string& title, CLI::App* app) {
      std::string help = help_of(app);
      text += "\n## " + title + "\n\n```text\n" + help + "```\n";
    };
    add("cdem", &app_);
    for (const auto& name : command_names())
      if (name != "help")
        add("cdem " + name, app_.get_subcommand(name));
    return text;
  }

private:
  static Action print(std::string text) {
    return [text = std::move(text)] {
      std::fputs(text.c_str(), stdout);
      return ExitCode::success;
    };
  }

  static std::string help_of(CLI::App* app) {
    std::string text = app->help();
    // No blank lines at either end, one between parts.
    text.erase(0, text.find_first_not_of('\n'));
    while (!text.empty() && text.back() == '\n')
      text.pop_back();
    for (auto at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n"))
      text.erase(at, 1);
    return text + "\n";
  }

  std::vector<std::string> command_names() const {
    std::vector<std::string> names;
    for (const auto* command : app_.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    return names;
  }

  static void add_options(CLI::App* app, const Command& command) {
    for (const Command::Option& option : command.options) {
      CLI::Option* made = nullptr;
      switch (option.kind) {
      case Command::Kind::argument:
        made = app->add_option(option.names, *option.value, option.text)->option_text(" ");
        break;
      case Command::Kind::value:
        made = app->add_option(option.names, *option.value, option.text)->option_text(option.form);
        if (option.flag != nullptr)
          made->each([typed = option.flag](const std::string&) { *typed = true; });
        break;
      case Command::Kind::values:
        made = app->add_option(option.names, *option.values, option.text)
                   ->option_text(option.form)
                   ->allow_extra_args(false);
        break;
      case Command::Kind::flag:
        made = app->add_flag(option.names, *option.flag, option.text);
        break;
      }
      if (option.hidden)
        made->group("");
    }
  }

  // What the parser left over: the first of it names the mistake.
  void refuse_extras(CLI::App* command) const {
    const auto top = app_.remaining();
    if (command == nullptr) {
      for (const auto& word : top)
        if (!word.empty() && word.front() == '-')
          refuse_option(word, &app_);
      if (!top.empty())
        throw UsageError("no command '" + top.front() + "'" +
                         script::did_you_mean(top.front(), command_names()) +
                         (top.front().size() > 4 && top.front().substr(top.front().size() - 4) == ".lua"
                              ? "; to run a script: cdem run " + top.front()
                              : "; cdem --help lists them"));
      return;
    }
    auto words = command->remaining();
    words.insert(words.end(), top.begin(), top.end());
    for (const auto& word : words)
      if (word.size() > 1 && word.front() == '-')
        refuse_option(word, command);
    if (!words.empty())
      throw UsageError("cdem " + command->get_name() + ": unexpected '" + words.front() + "'; cdem help " +
                       command->get_name() + " lists what it takes");
  }

  static void refuse_option(const std::string& word, const CLI::App* command) {
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string> names;
    for (const auto* option :
         command->get_options([](const CLI::Option* o) { return !o->get_positional(); })) {
      for (const auto& long_name : option->get_lnames())
        names.push_back("--" + long_name);
    }
    const std::string who = command->get_parent() == nullptr ? "cdem" : "cdem " + command->get_name();
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw UsageError("cdem: " + name + " belongs after the command: " + who + " ... " + name);
    throw UsageError(who + ": no option " + name +
                     (name.size() > 2 ? script::did_you_mean(name, names) : std::string()));
  }

  Action action() {
    const auto chosen = app_.get_subcommands();
    refuse_extras(chosen.empty() ? nullptr : chosen.front());
    if (version_)
      return print("cdem " + version() + "\n");
    if (manual_)
      return print(manual());
    if (!shell_files_.empty())
      return [all = declared(program_, commands_), folder = shell_files_] {
        write_shell_files(all, folder);
        return ExitCode::success;
      };
    for (const Command& command : commands_)
      if (!chosen.empty() && command.name == chosen.front()->get_name())
        return command.action(line_);
    return print(help_of(&app_));
  }

  Action help_action() {
    if (topic_.empty())
      return print(help_of(&app_));
    for (const auto& name : command_names())
      if (name == topic_)
        return print(help_of(app_.get_subcommand(name)));
    throw UsageError("no command '" + topic_ + "'" + script::did_you_mean(topic_, command_names()));
  }

  Command program_{
      "cdem", "cdem: continuum-based discrete element method.\n"
              "Lua scripts build assemblies of deformable blocks, load and break them, and write pictures,\n"
              "ParaView files and a report into results/."};
  CLI::App app_;
  std::vector<Command> commands_{run_command(),    resume_command(),     check_command(), sweep_command(),
                                 render_command(), view_command(),       info_command(),  convert_command(),
                                 repl_command(),   annotations_command()};
  std::string topic_, shell_files_; // of help, and of the hidden --shell-files
  bool version_ = false, manual_ = false;
  TypedLine line_;
};

} // namespace

std::function<ExitCode()> parse_command_line(int argc, const char* const* argv) {
  return Parser().parse(argc, argv);
}

} // namespace cdem::app
