// Options that several commands have, written once, and what they mean.
#pragma once

#include "apps/cdem/command_line/command.hpp"
#include "apps/cdem/commands/commands.hpp"

namespace cdem::app {

void add_script(Command&, std::string& file);
void add_unsafe(Command&, bool&);
void add_threads(Command&, std::string&, const std::string& text);
void add_memory(Command&, std::string&);
void add_set(Command&, std::vector<std::string>&, const std::string& form, const std::string& text);
void add_output(Command&, std::string&, const std::string& form, const std::string& text);
void add_quiet(Command&, bool&);

inline constexpr int most_threads = 1024;
int threads_of(const std::string& typed);        // 0: not said
std::size_t memory_of(const std::string& typed); // bytes; 0: not said
int ranks_of(const std::string& typed);          // 1 where it is not said

// "cdem check: which file? usage: cdem check FILE.lua"
void require_file(const std::string& file, const std::string& command, const std::string& usage);

// UsageError where this is one of several ranks: for a command that does not solve one model.
void refuse_ranks(const std::string& command);

// Options of run and resume.
struct SolvingOptions {
  std::string threads, ranks, memory, checkpoint_every = "10";
  bool unsafe = false, live = false, quiet = false;

  void add_computing(Command&); // threads, ranks, memory
  void add_watching(Command&);  // checkpoints, the page, progress
  SolvingCommand command(const TypedLine&) const;
  // `here`, or as the several ranks that --ranks asks for.
  Action among_ranks(Action here, const TypedLine&) const;
};

} // namespace cdem::app
