// How the next frame is to be drawn, as the page asks for it.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/vtk/picture.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cdem::app {

// A file that the page offers: a saved state, or a series with a state per step.
struct ShownFile {
  std::string name;
  int steps = 1;
};

struct FrameWish {
  int file = 0, step = 0;                        // from 0; of a live run always 0
  std::string colour = "displacement.magnitude"; // "": plain blocks
  std::optional<std::array<double, 2>> range;    // of the colours, SI units; none: that of the values
  double deformation = 1;                        // scale of the displacement
  std::string view, up;                          // as in pictures; empty where nobody has asked
  double turn = 0, tilt = 0;                     // degrees from the view: about the upward axis, then upwards
  double zoom = 1;                               // 1: the box of the model fills the frame
  std::array<double, 2> shift{0, 0};             // of the model, to the right and up, heights of the frame

  // Takes the words of a request. False, and nothing is changed: a name or value that means nothing.
  bool take(const std::map<std::string, std::string>& words, const std::vector<std::string>& fields,
            const std::vector<ShownFile>& files);
};

// Chooses what nobody has asked for. A plate is seen from the front, anything else from a corner with z up.
void choose_view(const Snapshot&, FrameWish&);

// A parallel camera fixed to `box` (m), so that the model keeps its place and scale from frame to frame.
PictureOptions frame_options(const FrameWish&, const Snapshot&, const geom::Box& box);

// Box of the points as a frame shows them, m.
geom::Box shown_box(const Snapshot&, double deformation);

} // namespace cdem::app
