// A picture of a snapshot, drawn off screen (no X server) on white, ready for a paper.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace cdem {

inline constexpr int least_picture_side = 64, most_picture_side = 8000; // pixels

using Colour = std::array<double, 3>; // red, green, blue in 0 .. 1
inline constexpr Colour black = {0, 0, 0};

// A camera taken literally; without one the named view is fitted to the body.
struct Camera {
  geom::Vec3 position = {0, 0, 1};    // m
  geom::Vec3 focal_point = {0, 0, 0}; // m
  geom::Vec3 up = {0, 1, 0};
  double view_angle = 30;  // degrees over the height of the frame
  bool perspective = true; // false: parallel, showing the same height at the focal point
};

// Drawn on top of the body, at undeformed places.
struct Marker {
  geom::Vec3 position = {0, 0, 0}; // m
  std::string label;               // written beside the marker
  Colour colour = {0, 0, 0};
  double size = 14; // diameter, pixels of a 1600 x 1200 picture
};
struct Polyline {
  std::vector<geom::Vec3> points; // m
  std::string label;              // goes into the legend
  Colour colour = {0, 0, 0};
  double width = 4; // pixels of a 1600 x 1200 picture
  bool dashed = false;
};

struct PictureOptions {
  // A field of the snapshot with its component: "displacement.x|y|z|magnitude", "stress.xx|yy|zz|xy|yz|xz",
  // "principal_stress.1|2|3", "von_mises" (from "stress" when the snapshot has no such field), "block_id",
  // ... A vector without component means its magnitude. "" draws plain blocks.
  std::string field;
  std::vector<int> plain; // bodies, by their number in cell field "body", that are drawn without colour
  double opacity = 1;     // of the blocks, (0, 1]: below 1 broken interfaces inside show through
  double deformation = 0; // scale of the displacement, 0: undeformed
  // front back left right top bottom iso; front looks along -z at the x-y plane, y up
  std::string view = "front";
  std::string up = "y"; // "z": front looks along y with z up, and the other views turn with it
  std::optional<Camera> camera;
  // m, present places: a box to which a view is fitted instead of what is drawn, so that the frames of a film show the same
  std::optional<geom::Box> fit;
  std::array<int, 2> size = {1600, 1200};     // pixels; height 0: as high as the picture needs
  double dpi = 300;                           // pixels in an inch of the printed picture
  std::optional<std::array<double, 2>> range; // of the colours, SI units
  // "auto": blue_white_red with white at zero when the values change sign, else viridis; distinct colours for
  // ids. Or one of blue_white_red, cool_warm, viridis, grey, categorical.
  std::string colour_map = "auto";
  std::string title;        // "_{...}" and "^{...}" set sub- and superscripts
  bool edges = true;        // outlines of the blocks
  bool broken_bonds = true; // broken interfaces, coloured by how they broke
  bool colour_bar = true;
  bool legend = true;
  bool axes = true;                // small arrows that name the directions
  bool scale_bar = false;          // a round length under the body; not in perspective
  std::optional<geom::Vec3> north; // gets an arrow beside those of the axes
  std::vector<Marker> markers;
  std::vector<Polyline> polylines;
};

// Writes a .png; or .svg or .pdf, with the model as pixels, its title, colour bar and legend as shapes. Throws
// geom::InputError for an option that cannot be used (an unknown field names the nearest right ones), std::runtime_error when the machine offers no off-screen OpenGL.
void render(const Snapshot&, const PictureOptions&, const std::string& path);

// The same as the bytes of a .png.
std::string render_png(const Snapshot&, const PictureOptions&);

// What `field` may be for this snapshot, with components.
std::vector<std::string> picture_fields(const Snapshot&);

} // namespace cdem
