// Shows a run while it goes on: one line that changes on a terminal, a plain line every ten seconds
// elsewhere, all of it in the log; warnings on stderr. Asks the run to stop after Ctrl-C.
#pragma once

#include "apps/cdem/live/live_view.hpp"
#include "apps/cdem/progress/time_left.hpp"
#include "apps/cdem/results/output_folder.hpp"
#include "libcdem/step/observer.hpp"

#include <chrono>
#include <memory>
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
  void warning(const std::string&) override; // on stderr, of a quiet run too
  void goes_on(std::int64_t broken_tension, std::int64_t broken_shear, std::int64_t warnings) override;
  bool stop_requested() override;
  Activity doing(Activity) override;

  bool wants_view() override;
  std::string wanted_field() override;
  void view(const Snapshot&) override;

  // From now on a page of the browser shows the run too; null on ranks other than 0, which give their share to its frames.
  void show_in(std::shared_ptr<LiveView> page) {
    page_ = std::move(page);
    live_ = true;
  }

  // Takes the live line off the screen; before anything else prints.
  void clear_line();

  // "1,204 broken (4 tension, 1,200 shear), 1 warning; " of all stages; "" when there was nothing of it.
  std::string in_all() const;

private:
  using Clock = std::chrono::steady_clock;
  template <class Act>
  static void told(const Act&);
  void take(const Progress&);
  void tell(const std::string& line);
  void start_stage(const Progress&, Clock::time_point now);
  void show(const Progress&, Clock::time_point now);
  void end_stage(const Progress&);
  void print(const std::string& line);

  ProgressStyle style_;
  OutputFolder* folder_;
  std::shared_ptr<LiveView> page_; // may be null
  bool live_ = false;
  TimeLeft left_;
  static constexpr int no_stage = -1;
  int stage_ = no_stage;
  bool line_shown_ = false;
  std::int64_t broken_tension_ = 0, broken_shear_ = 0, warnings_ = 0; // of all stages so far
  Clock::time_point last_shown_, last_logged_;
};

} // namespace cdem::app
