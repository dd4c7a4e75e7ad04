// cdem repl: Lua with the cdem module at hand, line by line. On a terminal readline gives history and the tab
// key; its callback interface is used because our own wait for input lets Ctrl-C cancel the line without a
// jump out of a signal handler. From a pipe, lines are read to the end and the first error ends the program.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/memory.hpp"
#include "lua/binding/module/topics.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <poll.h>
#include <readline/history.h>
#include <readline/readline.h>
#include <signal.h>
#include <unistd.h>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

constexpr int history_length = 2000;

// $XDG_STATE_HOME/cdem/repl_history; empty when there is no home.
fs::path history_file() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/')
    return fs::path(state) / "cdem" / "repl_history";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return fs::path(home) / ".local" / "state" / "cdem" / "repl_history";
  return {};
}

// What readline's C callbacks reach.
script::Engine* completing_engine = nullptr;
std::string finished_line;
bool line_finished = false, input_ended = false;

char* next_match(const char* word, int state) {
  static std::vector<std::string> matches;
  static std::size_t index;
  if (state == 0) {
    matches = completing_engine->complete(word);
    index = 0;
  }
  return index < matches.size() ? strdup(matches[index++].c_str()) : nullptr;
}

char** complete_names(const char* text, int, int) {
  rl_attempted_completion_over = 1; // never file names
  rl_completion_suppress_append = 1;
  return rl_completion_matches(text, next_match);
}

void take_line(char* line) {
  rl_callback_handler_remove(); // or it would print the prompt again
  line_finished = true;
  input_ended = line == nullptr; // Ctrl-D
  finished_line = input_ended ? "" : line;
  std::free(line);
}

// Ctrl-C is let in only while we wait for keys: no press is lost between the question and the wait.
class InterruptsHeld {
public:
  InterruptsHeld() {
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    sigaddset(&held, SIGTERM);
    sigprocmask(SIG_BLOCK, &held, &before_);
  }
  ~InterruptsHeld() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  const sigset_t& before() const { return before_; }

private:
  sigset_t before_{};
};

enum class Key { line, cancelled, end };

class Terminal {
public:
  explicit Terminal(script::Engine& engine) : history_(history_file()) {
    completing_engine = &engine;
    rl_readline_name = "cdem";
    rl_catch_signals = 0;
    rl_attempted_completion_function = complete_names;
    rl_basic_word_break_characters = " \t\n\"\\'`@$><=;|&{}()[]+-*/^%~#,";
    using_history();
    stifle_history(history_length);
    if (!history_.empty())
      read_history(history_.c_str());
  }
  ~Terminal() {
    if (history_.empty())
      return;
    std::error_code error; // a history that cannot be written is no reason to complain
    fs::create_directories(history_.parent_path(), error);
    write_history(history_.c_str());
  }

  Key read(const char* prompt, std::string& line) {
    const InterruptsHeld held;
    line_finished = false;
    rl_callback_handler_install(prompt, take_line);
    while (!line_finished) {
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (ppoll(&input, 1, nullptr, &held.before()) < 0) {
        if (interrupt::requested()) {
          rl_callback_sigcleanup();
          rl_free_line_state();
          rl_callback_handler_remove();
          std::puts("^C");
          return interrupt::exit_code() == ExitCode::terminated ? Key::end : Key::cancelled;
        }
        rl_resize_terminal(); // a changed window is the other signal that comes
        continue;
      }
      rl_callback_read_char();
    }
    line = finished_line;
    return input_ended ? Key::end : Key::line;
  }

  void remember(const std::string& text) {
    if (!text.empty())
      add_history(text.c_str());
  }

private:
  fs::path history_;
};

// "help", "help model:fix", "help(cdem.grid)" and help"..." ask about names; anything else is Lua.
bool asks_for_help(const std::string& line, std::string& name) {
  constexpr std::size_t length = 4;
  if (line.rfind("help", 0) != 0)
    return false;
  name = line.substr(length);
  const auto end = name.find_last_not_of(" \t\"')");
  name.resize(end == std::string::npos ? 0 : end + 1);
  const auto begin = name.find_first_not_of(" \t\"'(");
  const bool apart = line.size() == length || std::strchr(" \t\"'(", line[length]) != nullptr;
  name = begin == std::string::npos ? "" : name.substr(begin);
  return apart && name.find_first_of("=,+ ") == std::string::npos;
}

void print_result(const std::string& text) {
  if (!text.empty())
    std::printf("%s%s", text.c_str(), text.back() == '\n' ? "" : "\n");
  std::fflush(stdout);
}

ExitCode interactive(script::Engine& engine, RunObserver& observer) {
  std::printf("cdem %s, Lua with the cdem module. Tab completes, help tells, Ctrl-C cancels, Ctrl-D ends.\n",
              version().c_str());
  Terminal terminal(engine);
  std::string chunk;
  for (;;) {
    interrupt::clear();
    std::string line;
    const Key key = terminal.read(chunk.empty() ? "> " : ">> ", line);
    if (key == Key::end)
      break;
    if (key == Key::cancelled) {
      chunk.clear();
      continue;
    }
    terminal.remember(line);
    chunk += (chunk.empty() ? "" : "\n") + line;
    bool incomplete = false;
    try {
      std::string name;
      const std::string result =
          asks_for_help(chunk, name) ? script::help(name) : engine.run_line(chunk, incomplete);
      observer.clear_line();
      if (!incomplete)
        print_result(result);
    } catch (...) {
      observer.clear_line();
      print_failure(current_failure());
    }
    if (!incomplete)
      chunk.clear();
  }
  std::puts("");
  return interrupt::requested() ? interrupt::exit_code() : ExitCode::success;
}

ExitCode from_pipe(script::Engine& engine) {
  std::string chunk;
  bool incomplete = false;
  for (std::string line; std::getline(std::cin, line);) {
    chunk += (chunk.empty() ? "" : "\n") + line;
    std::string name;
    print_result(asks_for_help(chunk, name) ? script::help(name) : engine.run_line(chunk, incomplete));
    if (!incomplete)
      chunk.clear();
  }
  if (incomplete)
    throw UsageError("the input ends inside an unfinished statement: " + chunk.substr(0, chunk.find('\n')));
  return ExitCode::success;
}

} // namespace

ExitCode repl(const ReplCommand& command) {
  script::EngineSettings settings;
  settings.output = fs::path("results") / "repl";
  settings.results = "results";
  settings.threads = command.threads > 0 ? command.threads : available_cores();
  settings.unsafe = command.unsafe;
  const auto observer = std::make_shared<RunObserver>(ProgressStyle::automatic, nullptr);
  settings.observer = observer;
  settings.memory = limit_memory(command.memory);
  settings.program = program_path().string();
  script::Engine engine(settings);
  return isatty(STDIN_FILENO) == 1 ? interactive(engine, *observer) : from_pipe(engine);
}

} // namespace cdem::app
