#include "apps/cdem/progress/run_observer.hpp"

#include "apps/cdem/interrupt.hpp"
#include "apps/cdem/progress/line.hpp"
#include "apps/cdem/progress/terminal.hpp"

#include <cstdio>

namespace cdem::app {

namespace {

using std::chrono::milliseconds;
constexpr milliseconds live_interval{100};
constexpr milliseconds machine_interval{500};
constexpr milliseconds plain_interval{10000};

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

} // namespace

RunObserver::RunObserver(ProgressStyle style, OutputFolder* folder) : style_(style), folder_(folder) {
  if (style_ == ProgressStyle::automatic)
    style_ = is_live_terminal() ? ProgressStyle::live : ProgressStyle::plain;
}

RunObserver::~RunObserver() {
  clear_line();
}

void RunObserver::progress(const Progress& progress) {
  const auto now = Clock::now();
  if (progress.stage != stage_)
    start_stage(progress, now);
  left_.add(progress, seconds(now - stage_start_));
  if (progress.last)
    end_stage(progress, now);
  else
    show(progress, now);
}

void RunObserver::start_stage(const Progress& progress, Clock::time_point now) {
  if (folder_ != nullptr)
    folder_->begin_results();
  stage_ = progress.stage;
  stage_start_ = last_logged_ = now;
  last_shown_ = now - plain_interval;
}

void RunObserver::show(const Progress& progress, Clock::time_point now) {
  if (style_ == ProgressStyle::live && now - last_shown_ >= live_interval) {
    // The last column stays free: writing there would wrap on some terminals.
    std::printf("\r\033[K%s", live_line(progress, left_, terminal_columns() - 1).c_str());
    std::fflush(stdout);
    line_shown_ = true;
    last_shown_ = now;
  } else if (style_ == ProgressStyle::machine && now - last_shown_ >= machine_interval) {
    std::printf("@%d %s %.4f %.1f\n", progress.stage, progress.kind.c_str(), left_.fraction(),
                left_.seconds());
    std::fflush(stdout);
    last_shown_ = now;
  }
  if (now - last_logged_ < plain_interval)
    return;
  last_logged_ = now;
  const std::string line = plain_line(progress, left_);
  if (style_ == ProgressStyle::plain)
    print(line);
  if (folder_ != nullptr)
    folder_->log(line);
}

void RunObserver::end_stage(const Progress& progress, Clock::time_point now) {
  const std::string line = stage_line(progress, seconds(now - stage_start_));
  stage_ = 0;
  message(line);
}

void RunObserver::message(const std::string& text) {
  if (style_ == ProgressStyle::live || style_ == ProgressStyle::plain)
    print(text);
  if (folder_ != nullptr)
    folder_->log(text);
}

bool RunObserver::stop_requested() {
  return interrupt::requested();
}

void RunObserver::clear_line() {
  if (!line_shown_)
    return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
  line_shown_ = false;
}

void RunObserver::print(const std::string& line) {
  clear_line();
  std::puts(line.c_str());
  std::fflush(stdout);
}

} // namespace cdem::app
