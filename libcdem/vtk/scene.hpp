// The body in space: coloured faces, outlines of blocks, broken interfaces. Lines are thin strips that face
// the viewer, so they have the same width on every OpenGL, and lie a few pixels in front of the faces they
// outline.
#pragma once

#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/outline.hpp"

#include "libcdem/vtk/view.hpp"
#include "libcdem/vtk/water_line.hpp"

#include <memory>

class vtkRenderer;

namespace cdem {

inline constexpr Colour tension_colour = {0.84, 0.0, 0.55};
inline constexpr Colour shear_colour = {0.0, 0.62, 0.25};
inline constexpr Colour plain_block_colour = {0.87, 0.85, 0.80};

struct SceneInput {
  const Snapshot& snapshot;
  const std::vector<geom::Vec3>& points; // of the snapshot, deformed
  const FieldValues* field = nullptr;    // null: plain blocks
  ColourScale scale;
  const BrokenInterfaces* broken = nullptr;
  bool edges = true;
  double opacity = 1; // of the blocks, (0, 1]: below 1 broken interfaces inside show through
  double pixel = 1;   // line widths are given for a 1600 x 1200 picture and multiplied by this
  std::vector<WaterSheet> water = {};   // a transparent sheet each, and its net
  std::vector<Segment> water_line = {}; // where they cut the bodies
  std::vector<Polyline> arrows = {};    // on the sheets, hidden by the bodies in front of them
};

class Scene {
public:
  // The view must have been fitted or placed in a picture of `size` pixels.
  Scene(const SceneInput&, const View&, const std::array<int, 2>& size);
  ~Scene();
  // To be drawn one over the other. With water there are two: the sheets tint only bodies without colour, which are in the
  // first; coloured ones are drawn after them, so that their colours remain those of the colour bar.
  std::vector<vtkRenderer*> renderers();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cdem
