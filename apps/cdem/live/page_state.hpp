// What the page shows: a run, or files that were saved. The program writes it, threads of the server read it.
#pragma once

#include "apps/cdem/live/frame_wish.hpp"
#include "libcdem/step/observer.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace cdem::app {

class PageState {
public:
  // stop: what the button says that ends it; files: none of a run.
  PageState(std::string name, std::string stop, std::vector<ShownFile> files = {});

  void progress(const Progress&, const std::string& line, double fraction, double seconds_left);
  void line(const std::string&); // the one under the bar
  void add_line(const std::string&);
  void frame(std::string png, std::vector<std::string> fields, const FrameWish& drawn);
  void
  refuse(const std::string& line); // the wish cannot be drawn: back to what is shown, with a line in the log
  bool stop();                     // false: it was asked to already
  void ended(const std::string& text);

  // JSON. Waits up to a second while the newest frame is still `seen`.
  std::string status(int seen);
  std::string frame() const;
  FrameWish wish() const;
  // False, and nothing is changed: a name or value that means nothing.
  bool wish(const std::map<std::string, std::string>&);
  bool wishes_changed();                                 // since the last frame
  void wait_for_wish(std::chrono::milliseconds longest); // or for stop()
  bool stops() const;
  bool was_read() const; // a page is open, or was
  // Until a page that was open has seen the end, 2 s at most.
  void wait_until_end_was_read() const;

private:
  struct Sample {
    double seconds, residual, kinetic, broken;
  };

  const std::string name_, stop_;
  const std::vector<ShownFile> files_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex one_at_a_time_;
  mutable std::condition_variable changed_; // a frame, a wish, the end
  std::string line_, end_, png_;
  double fraction_ = -1, seconds_left_ = -1, broken_before_ = 0, broken_in_stage_ = 0;
  int stage_ = 0;
  std::deque<std::string> log_;
  std::vector<Sample> samples_;
  std::vector<std::string> fields_;
  FrameWish wish_, drawn_;
  int frame_ = 0;
  bool stopping_ = false, ended_ = false, was_read_ = false, end_was_read_ = false, wished_ = false;
  std::size_t stride_ = 1, calls_ = 0;
};

} // namespace cdem::app
