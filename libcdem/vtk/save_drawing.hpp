// A drawing as a file: PNG, or SVG and PDF with the flat parts as shapes and text.
#pragma once

#include "libcdem/vtk/canvas.hpp"

namespace cdem {

// Throws geom::InputError for a size outside 64 .. 8000 or a resolution outside 10 .. 2400. Cheap: call it first.
void check_drawing(const std::array<int, 2>& size, double dpi);
// The same for a drawing that goes into a file. Throws geom::InputError for another ending than .png, .svg and .pdf too,
// FileError for a file that cannot be written.
void check_drawing(const std::array<int, 2>& size, double dpi, const std::string& path);

// The bytes of a .png: layers, then the canvas over them.
std::string png_of_drawing(const std::array<int, 2>& size, double dpi, std::vector<vtkRenderer*> layers,
                           Canvas&);

// below: drawn under the canvas, as pixels; may be empty. dpi: pixels in an inch where the file is printed.
void save_drawing(const std::array<int, 2>& size, double dpi, const std::vector<vtkRenderer*>& below, Canvas&,
                  const std::string& path);

} // namespace cdem
