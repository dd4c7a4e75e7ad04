#include "libcdem/vtk/layout.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double margin = 32, strip = 36, bar_gap = 44;
constexpr double title_height = 1.75 * title_font, legend_height = 2 * label_font;
constexpr double bar_title_height = 1.8 * label_font; // the line above the strip
constexpr double bar_row =
    0.9 * label_font + bar_title_height + strip + 1.75 * label_font; // a horizontal bar
constexpr double shortest_bar = 300;
constexpr double scale_bar_height = 2.2 * label_font;

struct Choice {
  bool bar_vertical, axes_left;
};

// Space that the other parts take from the body.
struct Room {
  double left, right, top, bottom;
};

Room room_beside(const LayoutInput& in, const Choice& choice) {
  const double s = in.pixel;
  Room room{margin * s, margin * s, margin * s, margin * s};
  if (in.title)
    room.top += title_height * s;
  if (in.bar && choice.bar_vertical)
    room.right += in.bar_column;
  double below = in.legend_rows > 0 ? (legend_height + (in.legend_rows - 1) * legend_row) * s : 0;
  if (in.scale_bar)
    below += scale_bar_height * s;
  if (in.bar && !choice.bar_vertical)
    below += bar_row * s;
  if (in.axes[0] > 0) {
    if (choice.axes_left)
      room.left += in.axes[0] + 0.5 * margin * s;
    else
      below = std::max(below, in.axes[1] + 0.6 * margin * s);
  }
  room.bottom += below;
  return room;
}

} // namespace

Layout arrange(const LayoutInput& in) {
  const double s = in.pixel;
  Layout layout;
  layout.size = in.size;
  const double aspect = in.aspect > 0 ? in.aspect : 4. / 3;

  std::vector<Choice> choices = {{true, true}, {true, false}, {false, true}, {false, false}};
  if (in.size[1] == 0) {
    // The width is given: a bar beside a tall body, below a wide one; axes under the body.
    choices = {{aspect < 1.8, false}};
    const Room room = room_beside(in, choices[0]);
    const double height =
        std::clamp((in.size[0] - room.left - room.right) / aspect, 0.15 * in.size[0], 2.0 * in.size[0]);
    layout.size[1] =
        std::min(most_picture_side, static_cast<int>(std::lround(height + room.top + room.bottom)));
  }
  Choice best = choices[0];
  double best_width = -1;
  for (const Choice& choice : choices) {
    const Room room = room_beside(in, choice);
    const double width = layout.size[0] - room.left - room.right,
                 height = layout.size[1] - room.top - room.bottom;
    const double body = std::min(width, height * aspect);
    if (body > 1.02 * best_width) { // the first ones are nicer: they yield only to a real gain
      best_width = body;
      best = choice;
    }
  }
  const Room room = room_beside(in, best);
  const double free_width = std::max(16., layout.size[0] - room.left - room.right);
  const double free_height = std::max(16., layout.size[1] - room.top - room.bottom);
  double width = free_width, height = free_height;
  if (in.aspect > 0) {
    width = std::min(free_width, free_height * aspect);
    height = width / aspect;
  }
  // Everything together stands in the middle of the picture; even pixels keep the viewport sharp.
  layout.body.width = std::floor(width);
  layout.body.height = std::floor(height);
  layout.body.left = std::floor(room.left + 0.5 * (free_width - width));
  layout.body.bottom = std::floor(room.bottom + 0.5 * (free_height - height));

  layout.title_middle = layout.body.top() + 0.5 * title_height * s;
  layout.bar_vertical = best.bar_vertical;
  double below = layout.body.bottom - (in.scale_bar ? scale_bar_height * s : 0);
  if (in.bar && best.bar_vertical) {
    const double full = layout.body.height - bar_title_height * s;
    const double length =
        std::max(0.94 * full, std::min(shortest_bar * s, free_height - bar_title_height * s));
    const double top = full >= length ? layout.body.top() - bar_title_height * s - 0.03 * full
                                      : layout.body.centre_y() + 0.5 * (length - bar_title_height * s);
    layout.bar = {std::round(layout.body.right() + bar_gap * s), std::round(top - length),
                  std::round(strip * s), std::round(length)};
  } else if (in.bar) {
    const double length = std::min(0.72 * layout.size[0], 1100 * s);
    const double top = below - (0.6 * label_font + bar_title_height) * s;
    double left = layout.body.centre_x() - 0.5 * length;
    if (in.axes[0] > 0 && !best.axes_left) // beside the arrows
      left = std::max(left, layout.body.left + in.axes[0] + 1.5 * margin * s);
    const double right = std::min(left + length, layout.size[0] - 2.5 * margin * s);
    layout.bar = {std::round(left), std::round(top - strip * s), std::round(right - left),
                  std::round(strip * s)};
    below -= bar_row * s;
  }
  layout.legend_middle = below - 0.55 * legend_height * s;
  if (best.axes_left)
    layout.axes_corner = {layout.body.left - in.axes[0] - 0.5 * margin * s, layout.body.bottom};
  else
    layout.axes_corner = {layout.body.left, layout.body.bottom - in.axes[1] - 0.6 * margin * s};
  layout.legend_left = margin * s;
  if (in.axes[0] > 0 && !best.axes_left)
    layout.legend_left = layout.axes_corner[0] + in.axes[0] + margin * s;
  return layout;
}

} // namespace cdem
