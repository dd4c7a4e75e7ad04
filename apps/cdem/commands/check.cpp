// cdem check: builds and validates what the script describes, without solving and without writing anything.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/memory.hpp"
#include "apps/cdem/process/rank.hpp"
#include "lua/binding/replay/led.hpp"

#include <cstdio>

namespace cdem::app {

namespace {

void print_what_there_is(const script::Engine& engine) {
  if (const auto parameters = engine.parameters(); !parameters.empty())
    std::printf("parameters\n%s\n", parameter_table(parameters).c_str());
  std::string summary = engine.model_summary();
  while (!summary.empty() && summary.back() == '\n')
    summary.pop_back();
  if (!summary.empty())
    std::printf("%s\n\n", summary.c_str());
}

} // namespace

ExitCode check(const CheckCommand& command) {
  script::led_act("script", [&] { require_script(command.script); });
  script::EngineSettings settings;
  settings.script = command.script;
  settings.output = std::filesystem::path("results") / case_name(command.script, command.set);
  settings.results = "results";
  settings.threads = command.threads > 0 ? command.threads : available_cores();
  settings.set = command.set;
  settings.unsafe = command.unsafe;
  settings.check_only = true;
  settings.memory = limit_memory(command.memory, ranks_on_these_cores());
  const auto observer = std::make_shared<RunObserver>(ProgressStyle::plain, nullptr);
  settings.observer = observer;
  settings.program = program_path().string();

  script::Engine engine(settings);
  try {
    engine.run_file();
  } catch (...) {
    print_what_there_is(engine); // a place outside the model is found with the model's box in sight
    throw;
  }
  print_what_there_is(engine);
  std::printf("%s: %sno errors found\n", command.script.c_str(), observer->in_all().c_str());
  return ExitCode::success;
}

} // namespace cdem::app
