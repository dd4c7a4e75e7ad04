// `cdem run --live`: the run in a browser page while it goes on, with frames of the model, progress, charts and a button
// that stops it as Ctrl-C does. Frames are drawn by the run's own thread between two steps, so that they take at most a
// tenth of its time.
#pragma once

#include "apps/cdem/live/page_state.hpp"
#include "apps/cdem/live/server.hpp"
#include "libcdem/results/snapshot.hpp"

namespace cdem::app {

class LiveView {
public:
  explicit LiveView(const std::string& name); // of the case
  ~LiveView();                                // waits up to 2 s until the page has seen the end
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  const std::string& url() const { return server_.url(); }

  // line: the same for people; fraction and seconds to the end of the stage, negative when unknown.
  void progress(const Progress& progress, const std::string& line, double fraction, double seconds_left) {
    shown_.progress(progress, line, fraction, seconds_left);
  }
  void add_line(const std::string& line) { shown_.add_line(line); }
  bool wants_frame();
  std::string wanted_field();  // of the next frame
  void frame(const Snapshot&); // what cannot be drawn is told of in the log and tried no more
  void ended(const std::string& text) { shown_.ended(text); }

private:
  using Clock = std::chrono::steady_clock;

  PageState shown_;
  LiveServer server_; // last: its threads use the others
  Clock::time_point next_frame_;
  FrameWish wish_; // of the next frame
  bool draws_ = true;
};

} // namespace cdem::app
