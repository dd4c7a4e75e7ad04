#include "apps/cdem/command_line/common_options.hpp"

#include "apps/cdem/command_line/option_values.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/memory.hpp"
#include "apps/cdem/process/start_ranks.hpp"
#include "libcdem/ranks/ranks.hpp"

namespace cdem::app {

void add_script(Command& command, std::string& file) {
  command.argument("FILE", file, "the case script, a .lua file");
}

void add_unsafe(Command& command, bool& unsafe) {
  command.flag("--unsafe", unsafe, "let the script use all of Lua and any file (trusted scripts only)");
}

void add_threads(Command& command, std::string& threads, const std::string& text) {
  command.value("--threads", threads, "N", text);
}

void add_memory(Command& command, std::string& memory) {
  command.value("--memory", memory, "SIZE",
                "the most it may take, as in 12G or 800M (nine tenths of the machine's)");
}

void add_set(Command& command, std::vector<std::string>& set, const std::string& form,
             const std::string& text) {
  command.values("--set", set, form, text);
}

void add_output(Command& command, std::string& output, const std::string& form, const std::string& text) {
  command.value("--output,-o", output, form, text);
}

void add_quiet(Command& command, bool& quiet) {
  command.flag("--quiet,-q", quiet, "print nothing but warnings and errors");
}

int threads_of(const std::string& typed) {
  return typed.empty() ? 0 : whole_number("--threads", typed, 1, most_threads);
}

std::size_t memory_of(const std::string& typed) {
  return typed.empty() ? 0 : memory_value("--memory", typed);
}

int ranks_of(const std::string& typed) {
  return typed.empty() ? 1 : whole_number("--ranks", typed, 1, most_ranks);
}

void require_file(const std::string& file, const std::string& command, const std::string& usage) {
  if (file.empty())
    throw UsageError("cdem " + command + ": which file? usage: cdem " + command + " " + usage);
}

void refuse_ranks(const std::string& command) {
  if (processes_started() > 1)
    throw UsageError("cdem " + command + ": this is one of " + std::to_string(processes_started()) +
                     " ranks that mpirun or srun has started; start it by itself");
}

void SolvingOptions::add_computing(Command& command) {
  add_threads(command, threads,
              "threads (every core, shared among the ranks); results are the same bits for any number");
  command.value("--ranks", ranks, "N",
                "processes that solve the model together, by mpirun (1); the same bits for any number");
  add_memory(command, memory);
}

void SolvingOptions::add_watching(Command& command) {
  command.value("--checkpoint-every", checkpoint_every, "MINUTES",
                "minutes between checkpoints in a long stage (10); 0: none");
  command.flag("--live", live, "show the run in a browser page of this machine; its address is printed");
  add_quiet(command, quiet);
}

SolvingCommand SolvingOptions::command(const TypedLine& line) const {
  SolvingCommand c;
  c.threads = threads_of(threads);
  c.memory = memory_of(memory);
  c.unsafe = unsafe;
  c.progress = quiet ? ProgressStyle::none : ProgressStyle::automatic;
  c.checkpoint_minutes = real_number("--checkpoint-every", checkpoint_every);
  if (c.checkpoint_minutes < 0)
    throw UsageError("--checkpoint-every " + checkpoint_every +
                     ": must be a number of minutes >= 0; 0 writes none");
  c.live = live;
  c.line = line.text;
  return c;
}

Action SolvingOptions::among_ranks(Action here, const TypedLine& line) const {
  const int count = ranks_of(ranks);
  if (!ranks.empty() && processes_started() > 1)
    throw UsageError("--ranks " + ranks + ": this is one of " + std::to_string(processes_started()) +
                     " ranks that mpirun or srun has started; leave --ranks out");
  if (count == 1)
    return here;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.words.size(); ++i)
    if (line.words[i] == "--ranks")
      ++i;
    else if (line.words[i].rfind("--ranks=", 0) != 0)
      words.push_back(line.words[i]);
  return [count, words] { return start_ranks(count, words); };
}

} // namespace cdem::app
