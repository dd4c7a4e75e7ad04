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

  void started(std::size_t run, const std::string& name);
  void progress(std::size_t run, const std::string& line); // "@stage kind fraction seconds_left" of a run
  double ended(std::size_t run);                           // wall time, s
  void message(const std::string&);                        // stays on the screen
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
  Clock::time_point start_ = Clock::now();
};

} // namespace cdem::app
