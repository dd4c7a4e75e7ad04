// A drawing of flat shapes and text as SVG or PDF, over a picture where there is one. Text goes in as the outlines of its
// letters, so that it looks the same everywhere.
#pragma once

#include "libcdem/vtk/view.hpp"

#include <string>
#include <vector>

namespace cdem {

// All in pixels of the drawing, origin at the lower left.
struct VectorShape {
  std::vector<std::array<double, 2>> corners; // of a convex polygon
  Colour colour;
};
struct VectorText {
  std::string text;
  std::array<double, 2> at; // left end of the base line
  double size = 1;          // of the font
  double degrees = 0;       // turned by, about `at`
  Colour colour;
};
struct VectorPage {
  std::array<int, 2> size;
  double dpi = 300;                // pixels in an inch of the page
  std::string png;                 // below everything, over the whole page; empty: white
  std::vector<VectorShape> shapes; // each over those before it
  std::vector<VectorText> texts;   // over the shapes
};

std::string svg_of(const VectorPage&);
std::string pdf_of(const VectorPage&); // throws std::runtime_error when the library refuses

} // namespace cdem
