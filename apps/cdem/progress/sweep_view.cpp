#include "apps/cdem/progress/sweep_view.hpp"

#include "apps/cdem/process/terminal.hpp"
#include "apps/cdem/text/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace cdem::app {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

SweepView::SweepView(std::size_t runs, bool quiet)
    : runs_(runs), quiet_(quiet), live_(!quiet && is_live_terminal()) {}

void SweepView::progress(std::size_t run, const std::string& name, const std::string& line) {
  Shown& shown = running_.try_emplace(run, Shown{name, "starts", -1, Clock::now()}).first->second;
  std::istringstream words(line);
  char mark = 0;
  int stage = 0;
  std::string kind;
  double fraction = -1;
  if (!(words >> mark >> stage >> kind >> fraction) || mark != '@')
    return;
  shown.stage = stage > 0 ? "stage " + std::to_string(stage) + " " + kind : kind;
  shown.fraction = fraction;
}

void SweepView::ended(std::size_t run) {
  running_.erase(run);
  ++done_;
}

bool SweepView::is_due() const {
  return live_ && Clock::now() - drawn_ >= std::chrono::milliseconds(100);
}

void SweepView::message(const std::string& line) {
  if (quiet_)
    return;
  clear();
  std::puts(line.c_str());
  std::fflush(stdout);
}

std::string SweepView::total_line() const {
  const double fraction = static_cast<double>(done_) / static_cast<double>(runs_);
  std::string line =
      bar_text(fraction, 24) + " " + std::to_string(done_) + " of " + std::to_string(runs_) + " done";
  if (done_ > 0 && done_ < runs_) {
    const double wall = seconds_since(start_);
    line += ", about " + duration_text(wall * (1 - fraction) / fraction) + " left";
  }
  return line;
}

void SweepView::draw() {
  if (!live_)
    return;
  clear();
  drawn_ = Clock::now();
  const std::size_t columns = static_cast<std::size_t>(std::max(terminal_columns() - 1, 1));
  const int room = std::max(terminal_rows() - 2, 1); // more lines than the screen could not be taken back
  std::string screen;
  for (const auto& [run, shown] : running_) {
    if (lines_drawn_ + 1 > room)
      break;
    std::string line = shown.name + "  " + shown.stage;
    if (shown.fraction >= 0)
      line += "  " + std::to_string(static_cast<int>(std::floor(100 * shown.fraction))) + " %";
    line += "  " + duration_text(seconds_since(shown.start));
    screen += line.substr(0, columns) + "\n";
    ++lines_drawn_;
  }
  screen += total_line().substr(0, columns) + "\n";
  ++lines_drawn_;
  std::fputs(screen.c_str(), stdout);
  std::fflush(stdout);
}

void SweepView::clear() {
  if (lines_drawn_ == 0)
    return;
  std::printf("\033[%dA\r\033[J", lines_drawn_);
  lines_drawn_ = 0;
}

} // namespace cdem::app
