// cdem run: runs a case script; everything it makes goes into one folder, with the log and the script that
// made it.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/live/live_view.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/memory.hpp"
#include "apps/cdem/process/rank.hpp"
#include "apps/cdem/results/records.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "lua/binding/files/sources.hpp"
#include "lua/binding/replay/led.hpp"

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
    observer.message(std::string("the last good state could not be saved: ") + geom::plain_reason(error));
  }
}

void record_settings(const RunCommand& command, int threads, const script::Engine& engine,
                     OutputFolder& folder, const std::vector<RankLoad>& loads) {
  const fs::path file = folder.path() / "settings.json";
  folder.will_write(file);
  write_settings(
      {command.script.string(), version(), threads, command.unsafe, command.set, engine.parameters(), loads},
      file);
}

// After a failure, whose own error matters more than this one.
void record_if_possible(const RunCommand& command, int threads, const script::Engine& engine,
                        OutputFolder& folder) {
  try {
    if (folder.begun())
      record_settings(command, threads, engine, folder, {});
  } catch (const std::exception& error) {
    folder.log(error.what());
  }
}

// folder: of rank 0 alone, null on the others; number: of the run.
void run_script(const RunCommand& command, const fs::path& output, int threads, OutputFolder* folder,
                std::uint64_t number, const std::shared_ptr<RunObserver>& observer) {
  script::EngineSettings settings;
  settings.script = command.script;
  settings.sources = command.sources;
  settings.output = output;
  settings.results = "results";
  settings.threads = threads;
  settings.set = command.set;
  settings.unsafe = command.unsafe;
  settings.observer = observer;
  settings.will_write = [folder](const fs::path& file) { folder->will_write(file); };
  settings.program = program_path().string();
  settings.resume = command.resume;
  settings.run = number;
  settings.memory = limit_memory(command.memory, ranks_on_these_cores());
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
    (void)failure_of_all(current_failure());
    const Doing saves(observer.get(), Activity::saving);
    save_last_states(engine, *observer);
    if (folder != nullptr)
      record_if_possible(command, threads, engine, *folder);
    throw;
  }
  const std::vector<RankLoad> loads = loads_of_ranks();
  script::led_act("settings", [&] {
    for (std::size_t rank = 0; rank < loads.size(); ++rank)
      folder->log(load_text(static_cast<int>(rank), loads[rank]));
    record_settings(command, threads, engine, *folder, loads);
  });
}

ProgressStyle shown_progress(const RunCommand& command, bool leads) {
  if (!leads)
    return ProgressStyle::none;
  return command.progress == ProgressStyle::automatic && !stdout_is_users() ? ProgressStyle::plain
                                                                            : command.progress;
}

} // namespace

ExitCode run(const RunCommand& command) {
  if (command.ends_with_parent)
    interrupt::with_parent();
  const fs::path source = script::kept_source(command.sources, command.script.filename(), command.script);
  script::led_act("script", [&] { require_script(source); });
  std::signal(SIGPIPE, SIG_IGN); // `cdem run ... | head` must not end a long run
  const int threads =
      command.threads > 0 ? command.threads : std::max(1, available_cores() / ranks_on_these_cores());
  const fs::path output =
      command.output.empty() ? fs::path("results") / case_name(command.script, command.set) : command.output;

  std::unique_ptr<OutputFolder> folder; // of rank 0
  const script::Value number = script::led("the output folder", [&]() -> script::Value {
    folder = std::make_unique<OutputFolder>(
        output, command.script,
        "cdem " + version() + " (" + build_text() + "), " + ranks_text(threads) + ", " + command.line,
        command.resume.empty() ? OutputFolder::Start::anew : OutputFolder::Start::goes_on, source);
    return static_cast<std::int64_t>(folder->run());
  });
  const auto observer =
      std::make_shared<RunObserver>(shown_progress(command, folder != nullptr), folder.get());
  if (!ranks().alone())
    observer->message(ranks_text(threads));
  std::shared_ptr<LiveView> page;
  if (command.live) {
    script::led_act("the page", [&] {
      page = std::make_shared<LiveView>(output.filename().string());
      // Not into the log: others may read that, and whoever knows the address can stop the run.
      std::printf("watch the run at %s\n", page->url().c_str());
      std::fflush(stdout);
    });
    observer->show_in(page);
  }
  const auto finish = [&](ExitCode code, const std::string& error) {
    script::led_act("the end of the log", [&] { folder->finish(code, error); });
  };
  const interrupt::WhenStuck stuck([&](ExitCode code, std::string& line) {
    if (folder)
      folder->finish(code, line);
  });
  try {
    run_script(command, output, threads, folder.get(),
               static_cast<std::uint64_t>(*number.get<std::int64_t>()), observer);
  } catch (...) {
    observer->clear_line();
    const Failure failure = current_failure();
    if (page)
      page->ended("ended with exit code " + std::to_string(to_int(failure.code)) + ": " + failure.line);
    finish(failure.code, failure.details.empty() ? failure.line : failure.details);
    throw;
  }
  observer->message(observer->in_all() + "results in " + output.string());
  if (page)
    page->ended("ended well; results in " + output.string());
  finish(ExitCode::success, "");
  return ExitCode::success;
}

} // namespace cdem::app
