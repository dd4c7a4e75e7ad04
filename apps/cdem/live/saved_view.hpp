// `cdem view`: saved files in the browser page of a live run. The thread that calls show() reads and draws; threads of the
// server hand out what it has drawn.
#pragma once

#include "apps/cdem/live/page_state.hpp"
#include "apps/cdem/live/saved_files.hpp"
#include "apps/cdem/live/server.hpp"
#include "libcdem/results/snapshot.hpp"

#include <functional>
#include <optional>

namespace cdem::app {

class SavedView {
public:
  // Draws the first of the files that can be drawn. Throws what the first says where none can.
  SavedView(const std::string& name, std::vector<SavedFile> files);

  const std::string& url() const { return server_.url(); }

  // Draws what the page asks for until it is closed by its button, or until `stop` says so.
  void show(const std::function<bool()>& stop);

private:
  const Snapshot& snapshot(int file, int step);
  const geom::Box& box(const FrameWish&); // of the first and the last step of the file together, m
  void draw(FrameWish);

  std::vector<SavedFile> files_;
  PageState shown_;
  Snapshot snapshot_; // the one that was read last
  std::array<int, 2> read_{-1, -1};
  geom::Box box_;
  std::optional<std::pair<int, double>> box_of_; // file and deformation
  LiveServer server_;                            // last: its threads use the others
};

} // namespace cdem::app
