// Shows a run while it goes on: one line that changes on a terminal, a plain line every ten seconds
// elsewhere, all of it in the log. Asks the run to stop after Ctrl-C.
#pragma once

#include "apps/cdem/output_folder.hpp"
#include "apps/cdem/progress/time_left.hpp"
#include "libcdem/step/observer.hpp"

#include <chrono>
#include <string>

namespace cdem::app {

enum class ProgressStyle {
  automatic, // live on a terminal, else plain
  live,
  plain,
  machine, // one "@stage kind fraction seconds_left" line at most twice a second, for a sweep that watches
           // this run
  none,    // only the log
};

class RunObserver : public Observer {
public:
  // folder: where the log goes and which is told when results begin; may be null.
  RunObserver(ProgressStyle, OutputFolder* folder);
  ~RunObserver() override;

  void progress(const Progress&) override;
  void message(const std::string&) override;
  bool stop_requested() override;

  // Takes the live line off the screen; before anything else prints.
  void clear_line();

private:
  using Clock = std::chrono::steady_clock;
  void start_stage(const Progress&, Clock::time_point now);
  void show(const Progress&, Clock::time_point now);
  void end_stage(const Progress&, Clock::time_point now);
  void print(const std::string& line);

  ProgressStyle style_;
  OutputFolder* folder_;
  TimeLeft left_;
  static constexpr int no_stage = -1;
  int stage_ = no_stage;
  bool line_shown_ = false;
  Clock::time_point stage_start_, last_shown_, last_logged_;
};

} // namespace cdem::app
