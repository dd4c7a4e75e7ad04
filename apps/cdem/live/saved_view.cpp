#include "apps/cdem/live/saved_view.hpp"

#include "apps/cdem/text/text.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libgeom/core/plain_reason.hpp"

#include <exception>

namespace cdem::app {

namespace {

constexpr std::chrono::milliseconds look_for_stop{200};

std::vector<ShownFile> offered(const std::vector<SavedFile>& files) {
  std::vector<ShownFile> all;
  all.reserve(files.size());
  for (const SavedFile& file : files)
    all.push_back({file.name, static_cast<int>(file.steps.size())});
  return all;
}

} // namespace

SavedView::SavedView(const std::string& name, std::vector<SavedFile> files)
    : files_(std::move(files)), shown_(name, "End the viewer", offered(files_)),
      server_({[this](int seen) { return shown_.status(seen); }, [this] { return shown_.frame(); },
               [this](const auto& words) { return shown_.wish(words); }, [this] { shown_.stop(); }}) {
  std::exception_ptr first;
  for (std::size_t i = 0; i < files_.size(); ++i)
    try {
      shown_.wish({{"file", std::to_string(i)}});
      draw(shown_.wish());
      (void)shown_.wishes_changed(); // that one is drawn
      return;
    } catch (const std::exception&) {
      if (!first)
        first = std::current_exception();
    }
  std::rethrow_exception(first);
}

void SavedView::show(const std::function<bool()>& stop) {
  while (!shown_.stops() && !stop()) {
    if (!shown_.wishes_changed()) {
      shown_.wait_for_wish(look_for_stop);
      continue;
    }
    try {
      draw(shown_.wish());
    } catch (const std::exception& error) {
      shown_.refuse(geom::plain_reason(error));
    }
  }
  shown_.ended("the viewer has ended");
  shown_.wait_until_end_was_read();
}

const Snapshot& SavedView::snapshot(int file, int step) {
  if (read_ != std::array<int, 2>{file, step}) {
    read_ = {-1, -1};
    const auto& steps = files_[static_cast<std::size_t>(file)].steps;
    snapshot_ = read_vtu(steps[static_cast<std::size_t>(step)].string());
    read_ = {file, step};
  }
  return snapshot_;
}

const geom::Box& SavedView::box(const FrameWish& wish) {
  const std::pair<int, double> wanted{wish.file, wish.deformation};
  if (box_of_ != wanted) {
    const int last = static_cast<int>(files_[static_cast<std::size_t>(wish.file)].steps.size()) - 1;
    box_ = shown_box(snapshot(wish.file, 0), wish.deformation);
    const geom::Box end = shown_box(snapshot(wish.file, last), wish.deformation);
    box_.extend(end.min);
    box_.extend(end.max);
    box_of_ = wanted;
  }
  return box_;
}

void SavedView::draw(FrameWish wish) {
  const geom::Box frame = box(wish);
  const Snapshot& shown = snapshot(wish.file, wish.step);
  choose_view(shown, wish);
  const PictureOptions options = frame_options(wish, shown, frame);
  wish.colour = options.field;
  shown_.frame(render_png(shown, options), picture_fields(shown), wish);
  const SavedFile& file = files_[static_cast<std::size_t>(wish.file)];
  shown_.line(file.steps[static_cast<std::size_t>(wish.step)].filename().string() + ": time " +
              number_text(shown.time) + " s, step " + count_text(shown.step) +
              (shown.title.empty() ? "" : ", " + shown.title));
}

} // namespace cdem::app
