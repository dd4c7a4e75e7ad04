// A drawing as a file: PNG, or SVG and PDF with the flat parts as shapes and text.
#pragma once

#include "libcdem/vtk/canvas.hpp"

namespace cdem {

// Throws geom::InputError for a size outside 64 .. 8000, a resolution outside 10 .. 2400 or another ending than .png,
// .svg and .pdf; FileError for a file that cannot be written. Cheap: call it first.
void check_drawing(const std::array<int, 2>& size, double dpi, const std::string& path);

// below: drawn under the canvas, as pixels; may be empty. dpi: pixels in an inch where the file is printed.
void save_drawing(const std::array<int, 2>& size, double dpi, const std::vector<vtkRenderer*>& below, Canvas&,
                  const std::string& path);

} // namespace cdem
