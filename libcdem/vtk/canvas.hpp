// Flat drawing over a picture: lines, filled shapes and text in pixels of the final picture, origin at the
// lower left.
#pragma once

#include "libcdem/vtk/vector_page.hpp"
#include "libcdem/vtk/view.hpp"

#include <memory>

class vtkRenderer;

namespace cdem {

enum class HorizontalAlign { left, centre, right };
enum class VerticalAlign { baseline, middle, top }; // middle: of a digit; top: of a capital letter

class Canvas {
public:
  using Point = std::array<double, 2>;

  Canvas();
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void polygon(const std::vector<Point>&, const Colour&); // convex
  void rectangle(const Rect&, const Colour&);
  void frame(const Rect&, double width, const Colour&); // outline centred on the rectangle's sides
  void line(const Point& from, const Point& to, double width, const Colour&);
  void polyline(const std::vector<Point>&, double width, const Colour&, bool dashed = false); // round corners
  void disc(const Point& centre, double radius, const Colour&);
  void arrow(const Point& from, const Point& to, double width, const Colour&);

  // "_{...}" and "^{...}" set sub- and superscripts. Size: pixels of the font. Degrees turn about the anchor.
  void text(const std::string&, const Point& anchor, double size, HorizontalAlign, VerticalAlign,
            const Colour& = {0, 0, 0}, double degrees = 0);
  double text_width(const std::string&, double size) const;
  double widest(const std::vector<std::string>&, double size) const; // of these texts; 0 of none

  VectorPage page(const std::array<int, 2>& size) const; // the same as shapes and text

  // Transparent, to be drawn on top of a picture of `size` pixels, in this order. Call once, at the end.
  std::vector<vtkRenderer*> renderers(const std::array<int, 2>& size);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// DejaVu Sans (package fonts-dejavu-core, which VTK's own packages bring along): the fonts built into VTK
// lack Greek letters and superscripts. Throws std::runtime_error when it is not installed.
const std::string& font_file();

} // namespace cdem
