#include "apps/cdem/progress/run_observer.hpp"

#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/terminal.hpp"
#include "apps/cdem/progress/line.hpp"
#include "apps/cdem/text/text.hpp"
#include "lua/binding/replay/led.hpp"

#include <cstdio>
#include <sys/stat.h>
#include <unistd.h>

namespace cdem::app {

namespace {

using std::chrono::milliseconds;
constexpr milliseconds live_interval{100};
constexpr milliseconds machine_interval{500};
constexpr milliseconds plain_interval{10000};

// A sweep reads the last line of the file it gave us: there is no need for the older ones.
void start_console_again() {
  struct stat status {};
  if (fstat(STDOUT_FILENO, &status) == 0 && S_ISREG(status.st_mode) && ftruncate(STDOUT_FILENO, 0) == 0)
    lseek(STDOUT_FILENO, 0, SEEK_SET);
}

} // namespace

RunObserver::RunObserver(ProgressStyle style, OutputFolder* folder) : style_(style), folder_(folder) {
  if (style_ == ProgressStyle::automatic)
    style_ = is_live_terminal() ? ProgressStyle::live : ProgressStyle::plain;
}

RunObserver::~RunObserver() {
  clear_line();
}

// What fails here, a full disk as a rule, fails on rank 0 alone, in the middle of a step where the others cannot be told.
template <class Act>
void RunObserver::told(const Act& act) {
  if (!script::with_others())
    return act();
  try {
    const script::WithoutOthers alone;
    act();
  } catch (...) {
    const Failure failure = current_failure();
    interrupt::end_now(failure.code, failure.line);
  }
}

void RunObserver::progress(const Progress& progress) {
  told([&] { take(progress); });
}

void RunObserver::take(const Progress& progress) {
  const auto now = Clock::now();
  if (progress.stage != stage_)
    start_stage(progress, now);
  left_.add(progress, progress.wall_time);
  if (page_)
    page_->progress(progress, progress.last ? stage_line(progress) : plain_line(progress, left_),
                    left_.fraction(), left_.seconds());
  if (progress.last)
    end_stage(progress);
  else
    show(progress, now);
}

void RunObserver::start_stage(const Progress& progress, Clock::time_point now) {
  if (folder_ != nullptr && !progress.preparing)
    folder_->begin_results();
  stage_ = progress.stage;
  last_logged_ = now;
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
    start_console_again();
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

void RunObserver::end_stage(const Progress& progress) {
  const std::string line = stage_line(progress);
  stage_ = no_stage;
  if (!progress.trial) {
    broken_tension_ += progress.broken_tension;
    broken_shear_ += progress.broken_shear;
  }
  if (progress.stage > 0) {
    tell(line);
    if (folder_ != nullptr && !progress.times.empty())
      folder_->log("  time of the steps: " + progress.times);
  } else {
    clear_line(); // a sweep of the script or a layer laid: these tell themselves how they ended
  }
}

void RunObserver::message(const std::string& text) {
  told([&] { tell(text); });
}

void RunObserver::tell(const std::string& text) {
  if (style_ == ProgressStyle::live || style_ == ProgressStyle::plain)
    print(text);
  if (page_)
    page_->add_line(text);
  if (folder_ != nullptr)
    folder_->log(text);
}

void RunObserver::warning(const std::string& text) {
  ++warnings_;
  if (style_ != ProgressStyle::machine) { // the sweep that watches this run shows its own
    clear_line();
    std::fprintf(stderr, "%s\n", with_tone(text, Tone::warning).c_str());
  }
  if (page_)
    page_->add_line(text);
  if (folder_ != nullptr)
    folder_->log(text);
}

void RunObserver::goes_on(std::int64_t broken_tension, std::int64_t broken_shear, std::int64_t warnings) {
  broken_tension_ += broken_tension;
  broken_shear_ += broken_shear;
  warnings_ += warnings;
}

std::string RunObserver::in_all() const {
  std::string text;
  if (broken_tension_ + broken_shear_ > 0)
    text = broken_text(broken_tension_, broken_shear_);
  if (warnings_ > 0)
    text += (text.empty() ? "" : ", ") + count_text(warnings_) + (warnings_ == 1 ? " warning" : " warnings");
  return text.empty() ? text : text + "; ";
}

bool RunObserver::wants_view() {
  return live_ && script::agreed(page_ && page_->wants_frame() ? 1 : 0) > 0;
}

std::string RunObserver::wanted_field() {
  return page_ ? page_->wanted_field() : "";
}

void RunObserver::view(const Snapshot& snapshot) {
  if (page_)
    told([&] { page_->frame(snapshot); });
}

bool RunObserver::stop_requested() {
  return interrupt::requested_of_any();
}

Activity RunObserver::doing(Activity now) {
  return interrupt::doing(now);
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
