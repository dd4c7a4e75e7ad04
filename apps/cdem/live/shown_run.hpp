// What the page of a run shows. The run writes it, threads of the server read it.
#pragma once

#include "libcdem/step/observer.hpp"

#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace cdem::app {

// How the next frame is drawn.
struct FrameWish {
  std::string colour = "displacement.magnitude", view, up; // of views: empty where nobody has asked
  double deformation = 1;
};

class ShownRun {
public:
  ShownRun(std::string name, bool can_stop);

  void progress(const Progress&, const std::string& line, double fraction, double seconds_left);
  void add_line(const std::string&);
  void frame(std::string png, std::vector<std::string> fields, const FrameWish& drawn);
  bool stop(); // false: it was asked to already
  void ended(const std::string& text);

  std::string status(); // JSON
  std::string frame() const;
  FrameWish wish() const;
  // False, and nothing is changed: a name or value that means nothing.
  bool wish(const std::map<std::string, std::string>&);
  bool wishes_changed(); // since the last frame
  bool was_read() const; // a page is open, or was
  bool end_was_read() const;

private:
  struct Sample {
    double seconds, residual, kinetic, broken;
  };

  const std::string name_;
  const bool can_stop_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex one_at_a_time_;
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
