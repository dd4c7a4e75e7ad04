#include "apps/cdem/live/live_view.hpp"

#include "libcdem/vtk/picture.hpp"
#include "libgeom/core/plain_reason.hpp"

#include <algorithm>
#include <csignal>
#include <unistd.h>

namespace cdem::app {

namespace {

using std::chrono::milliseconds;
constexpr milliseconds shortest_between_frames{1000};
constexpr int computing_over_drawing = 9;

} // namespace

LiveView::LiveView(const std::string& name)
    : shown_(name, "Stop the run"),
      server_({[this](int seen) { return shown_.status(seen); }, [this] { return shown_.frame(); },
               [this](const auto& wishes) { return shown_.wish(wishes); },
               [this] {
                 if (shown_.stop()) // a second signal would end the program at once
                   kill(getpid(), SIGINT);
               }}) {}

LiveView::~LiveView() {
  shown_.wait_until_end_was_read();
}

bool LiveView::wants_frame() {
  return draws_ && shown_.was_read() && (Clock::now() >= next_frame_ || shown_.wishes_changed());
}

std::string LiveView::wanted_field() {
  wish_ = shown_.wish();
  return wish_.colour;
}

void LiveView::frame(const Snapshot& snapshot) {
  const auto start = Clock::now();
  try {
    FrameWish wish = wish_;
    choose_view(snapshot, wish);
    const PictureOptions options = frame_options(wish, snapshot, shown_box(snapshot, wish.deformation));
    wish.colour = options.field;
    shown_.frame(render_png(snapshot, options), picture_fields(snapshot), wish);
  } catch (const std::exception& error) {
    draws_ = false;
    shown_.add_line(std::string("no more frames: ") + geom::plain_reason(error));
  }
  next_frame_ = Clock::now() + std::max<Clock::duration>(shortest_between_frames,
                                                         computing_over_drawing * (Clock::now() - start));
}

} // namespace cdem::app
