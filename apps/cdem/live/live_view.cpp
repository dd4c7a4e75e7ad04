#include "apps/cdem/live/live_view.hpp"

#include "apps/cdem/progress/line.hpp"
#include "libcdem/vtk/picture.hpp"
#include "lua/binding/runtime/engine.hpp"
#include "lua/binding/runtime/files.hpp"

#include <algorithm>
#include <csignal>
#include <thread>
#include <unistd.h>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

using std::chrono::milliseconds;
constexpr milliseconds shortest_between_frames{1000}, longest_wait_for_page{2000};
constexpr int computing_over_drawing = 9;

fs::path private_folder() {
  std::string name = (fs::temp_directory_path() / "cdem-live-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw script::FileError(name + " cannot be made");
  return name;
}

// A plate is seen from the front, anything else from a corner with z up.
void choose_view(const Snapshot& snapshot, FrameWish& wish) {
  geom::Box box;
  for (const geom::Vec3& x : snapshot.points)
    box.extend(x);
  const bool plate = box.size().z() < 0.25 * std::min(box.size().x(), box.size().y());
  if (wish.view.empty())
    wish.view = plate ? "front" : "iso";
  if (wish.up.empty())
    wish.up = plate ? "y" : "z";
}

} // namespace

LiveView::LiveView(const std::string& name)
    : shown_(name, true), folder_(private_folder()),
      server_({[this] { return shown_.status(); }, [this] { return shown_.frame(); },
               [this](const auto& wishes) { return shown_.wish(wishes); },
               [this] {
                 if (shown_.stop()) // a second signal would end the program at once
                   kill(getpid(), SIGINT);
               }}) {}

LiveView::~LiveView() {
  const auto start = Clock::now();
  while (!shown_.end_was_read() && shown_.was_read() && Clock::now() - start < longest_wait_for_page)
    std::this_thread::sleep_for(milliseconds(20));
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void LiveView::progress(const Progress& progress, const TimeLeft& left) {
  shown_.progress(progress, progress.last ? stage_line(progress) : plain_line(progress, left),
                  left.fraction(), left.seconds());
}

bool LiveView::wants_frame() {
  return draws_ && shown_.was_read() && (Clock::now() >= next_frame_ || shown_.wishes_changed());
}

void LiveView::frame(const Snapshot& snapshot) {
  const auto start = Clock::now();
  try {
    FrameWish wish = shown_.wish();
    choose_view(snapshot, wish);
    PictureOptions options;
    const std::vector<std::string> fields = picture_fields(snapshot);
    if (std::find(fields.begin(), fields.end(), wish.colour) != fields.end())
      options.field = wish.colour;
    options.view = wish.view;
    options.up = wish.up;
    options.deformation = wish.deformation;
    options.size = {1200, 900};
    const fs::path file = folder_ / "frame.png";
    render(snapshot, options, file.string());
    shown_.frame(script::read_file(file), fields, wish);
  } catch (const std::exception& error) {
    draws_ = false;
    shown_.add_line(std::string("no more frames: ") + error.what());
  }
  next_frame_ = Clock::now() + std::max<Clock::duration>(shortest_between_frames,
                                                         computing_over_drawing * (Clock::now() - start));
}

} // namespace cdem::app
