// One view of many runs side by side: on a terminal a line a run and one for the whole, elsewhere only what
// ends.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace cdem::app {

class SweepView {
public:
  SweepView(std::size_t runs, bool quiet);
  ~SweepView() { clear(); }

  // A run is at `line`: "@stage kind fraction seconds_left", or anything while it starts.
  void progress(std::size_t run, const std::string& name, const std::string& line);
  void ended(std::size_t run);
  bool is_due() const;              // live, and some time has passed since the last draw
  void message(const std::string&); // stays on the screen
  void draw();
  void clear();

private:
  using Clock = std::chrono::steady_clock;
  struct Shown {
    std::string name, stage;
    double fraction = -1;
    Clock::time_point start;
  };
  std::string total_line() const;

  std::size_t runs_, done_ = 0;
  bool quiet_, live_;
  std::map<std::size_t, Shown> running_;
  int lines_drawn_ = 0;
  Clock::time_point start_ = Clock::now(), drawn_;
};

} // namespace cdem::app
