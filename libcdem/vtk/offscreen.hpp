// The one off-screen window of the process: renderers in, a PNG out.
#pragma once

#include "libcdem/vtk/view.hpp"

class vtkRenderer;

namespace cdem {

// Pictures are drawn with twice the pixels in each direction and averaged: smooth lines and text on any
// OpenGL.
inline constexpr int supersampling = 2;

void check_picture_size(const std::array<int, 2>& size); // throws geom::InputError outside 64 .. 8000

// Draws the renderers on top of each other, the first one at the bottom, on white. Viewports are set by the
// caller. Throws std::runtime_error when the machine offers no off-screen OpenGL. One thread at a time. Frame buffers take
// 250 bytes a pixel, 480 MB for 1600 x 1200: they are kept for the next picture, which may be the next frame of a film.
std::string png_of(const std::array<int, 2>& size, const std::vector<vtkRenderer*>& layers);
// The same for a chart, which seldom follows another one: it gives its frame buffers back, unless a picture has left some.
std::string flat_png_of(const std::array<int, 2>& size, const std::vector<vtkRenderer*>& layers);

// The part of a picture of `size` that `frame` covers, as VTK wants it: fractions left, bottom, right, top.
std::array<double, 4> viewport_of(const Rect& frame, const std::array<int, 2>& size);

} // namespace cdem
