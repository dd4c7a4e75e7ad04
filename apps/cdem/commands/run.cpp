// cdem run: runs a case script; everything it makes goes into one folder, with the log and the script that
// made it.
#include "apps/cdem/build_info.hpp"
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/failure.hpp"
#include "apps/cdem/interrupt.hpp"
#include "apps/cdem/live/live_view.hpp"
#include "apps/cdem/memory.hpp"
#include "apps/cdem/records.hpp"
#include "lua/binding/runtime/sources.hpp"

#include <csignal>
#include <cstdio>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

// What can still be saved after a stop or a failure. Nothing here may hide the error that led to it.
void save_last_states(script::Engine& engine, RunObserver& observer) {
  try {
    if (engine.model_saved_after_failure())
      observer.message("the last good state is in last_good.vtu");
  } catch (const std::exception& error) {
    observer.message(std::string("the last good state could not be saved: ") + error.what());
  }
}

void record_settings(const RunCommand& command, int threads, const script::Engine& engine,
                     OutputFolder& folder) {
  const fs::path file = folder.path() / "settings.json";
  folder.will_write(file);
  write_settings(
      {command.script.string(), version(), threads, command.unsafe, command.set, engine.parameters()}, file);
}

// After a failure, whose own error matters more than this one.
void record_if_possible(const RunCommand& command, int threads, const script::Engine& engine,
                        OutputFolder& folder) {
  try {
    if (folder.begun())
      record_settings(command, threads, engine, folder);
  } catch (const std::exception& error) {
    folder.log(error.what());
  }
}

void run_script(const RunCommand& command, int threads, OutputFolder& folder,
                const std::shared_ptr<RunObserver>& observer) {
  script::EngineSettings settings;
  settings.script = command.script;
  settings.sources = command.sources;
  settings.output = folder.path();
  settings.results = "results";
  settings.threads = threads;
  settings.set = command.set;
  settings.unsafe = command.unsafe;
  settings.observer = observer;
  settings.will_write = [&folder](const fs::path& file) { folder.will_write(file); };
  settings.program = program_path().string();
  settings.resume = command.resume;
  settings.run = folder.run();
  settings.memory = limit_memory(command.memory);
  settings.checkpoint_minutes = command.checkpoint_minutes;

  script::Engine engine(settings);
  const interrupt::WhenStuck stuck([&engine](ExitCode code, std::string& line) {
    if (code != ExitCode::interrupted && code != ExitCode::terminated)
      return; // a failure of another thread, while the script goes on
    if (const std::string place = engine.leave_stuck_script(); !place.empty())
      line += " while busy at " + place;
  });
  try {
    engine.run_file();
  } catch (...) {
    const Doing saves(observer.get(), Activity::saving);
    save_last_states(engine, *observer);
    record_if_possible(command, threads, engine, folder);
    throw;
  }
  record_settings(command, threads, engine, folder);
}

} // namespace

ExitCode run(const RunCommand& command) {
  if (!command.sources.empty()) // of a sweep
    interrupt::with_parent();
  const fs::path source = script::kept_source(command.sources, command.script.filename(), command.script);
  require_script(source);
  std::signal(SIGPIPE, SIG_IGN); // `cdem run ... | head` must not end a long run
  const int threads = command.threads > 0 ? command.threads : available_cores();
  const fs::path output =
      command.output.empty() ? fs::path("results") / case_name(command.script, command.set) : command.output;

  OutputFolder folder(output, command.script,
                      "cdem " + version() + " (" + build_text() + "), " + std::to_string(threads) +
                          (threads == 1 ? " thread, " : " threads, ") + command.line,
                      command.resume.empty() ? OutputFolder::Start::anew : OutputFolder::Start::goes_on,
                      source);
  const auto observer = std::make_shared<RunObserver>(command.progress, &folder);
  std::shared_ptr<LiveView> page;
  if (command.live) {
    page = std::make_shared<LiveView>(output.filename().string());
    // Not into the log: others may read that, and whoever knows the address can stop the run.
    std::printf("watch the run at %s\n", page->url().c_str());
    std::fflush(stdout);
    observer->show_in(page);
  }
  const interrupt::WhenStuck stuck(
      [&folder](ExitCode code, std::string& line) { folder.finish(code, line); });
  try {
    run_script(command, threads, folder, observer);
  } catch (...) {
    observer->clear_line();
    const Failure failure = current_failure();
    if (page)
      page->ended("ended with exit code " + std::to_string(to_int(failure.code)) + ": " + failure.line);
    folder.finish(failure.code, failure.details.empty() ? failure.line : failure.details);
    throw;
  }
  observer->message(observer->in_all() + "results in " + folder.path().string());
  if (page)
    page->ended("ended well; results in " + folder.path().string());
  folder.finish(ExitCode::success, "");
  return ExitCode::success;
}

} // namespace cdem::app
