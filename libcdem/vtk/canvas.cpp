#include "libcdem/vtk/canvas.hpp"

#include "libcdem/vtk/offscreen.hpp"

#include <algorithm>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkStdString.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace cdem {
namespace {

// Measures of DejaVu Sans, in units of the font size.
constexpr double descent = 0.236, digit_height = 0.729, script_size = 0.7;
constexpr double subscript_drop = 0.16, superscript_rise = 0.38;

struct Run {
  std::string text;
  double size = 1, rise = 0; // of the font size
};

std::vector<Run> runs_of(const std::string& markup) {
  std::vector<Run> runs = {{}};
  for (std::size_t i = 0; i < markup.size(); ++i) {
    const bool script =
        (markup[i] == '_' || markup[i] == '^') && i + 1 < markup.size() && markup[i + 1] == '{';
    const std::size_t end = script ? markup.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      runs.back().text += markup[i];
      continue;
    }
    runs.push_back({markup.substr(i + 2, end - i - 2), script_size,
                    markup[i] == '_' ? -subscript_drop : superscript_rise});
    runs.push_back({});
    i = end;
  }
  return runs;
}

void set_font(vtkTextProperty* property, double pixels) {
  property->SetFontFamily(VTK_FONT_FILE);
  property->SetFontFile(font_file().c_str());
  property->SetFontSize(static_cast<int>(std::lround(pixels)));
}

// In drawn (supersampled) pixels. Between two letters, because the renderer trims blanks at the ends.
double run_width(const std::string& text, double pixels) {
  if (text.empty())
    return 0;
  vtkNew<vtkTextProperty> property;
  set_font(property, pixels);
  const auto width = [&](const std::string& s) {
    int box[4] = {0, 0, 0, 0};
    vtkTextRenderer::GetInstance()->GetBoundingBox(property, vtkStdString(s), box, 72);
    return box[1] - box[0];
  };
  return width("n" + text + "n") - width("nn");
}

} // namespace

const std::string& font_file() {
  static const std::string file = [] {
    for (const char* candidate :
         {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
          "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf"})
      if (std::filesystem::exists(candidate))
        return std::string(candidate);
    throw std::runtime_error("pictures need the font DejaVu Sans; install fonts-dejavu-core");
  }();
  return file;
}

struct Canvas::Impl {
  vtkNew<vtkRenderer> shapes, texts;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  std::vector<VectorShape> flat;
  std::vector<VectorText> written;
};

Canvas::Canvas() : impl_(std::make_unique<Impl>()) {
  impl_->points->SetDataTypeToDouble();
  impl_->colours->SetNumberOfComponents(3);
  impl_->shapes->SetPreserveColorBuffer(1);
  impl_->texts->SetPreserveColorBuffer(1);
}
Canvas::~Canvas() = default;

void Canvas::polygon(const std::vector<Point>& corners, const Colour& colour) {
  // Later shapes lie nearer to the viewer, so that they cover earlier ones.
  const double height = static_cast<double>(impl_->cells->GetNumberOfCells());
  impl_->cells->InsertNextCell(static_cast<int>(corners.size()));
  for (const Point& p : corners)
    impl_->cells->InsertCellPoint(impl_->points->InsertNextPoint(p[0], p[1], height));
  std::array<unsigned char, 3> bytes;
  for (std::size_t c = 0; c < 3; ++c)
    bytes[c] = static_cast<unsigned char>(std::lround(255 * colour[c]));
  impl_->colours->InsertNextTypedTuple(bytes.data());
  impl_->flat.push_back({corners, colour});
}

void Canvas::rectangle(const Rect& r, const Colour& colour) {
  polygon({{r.left, r.bottom}, {r.right(), r.bottom}, {r.right(), r.top()}, {r.left, r.top()}}, colour);
}

void Canvas::frame(const Rect& r, double width, const Colour& colour) {
  const double h = width / 2;
  rectangle({r.left - h, r.bottom - h, r.width + width, width}, colour);
  rectangle({r.left - h, r.top() - h, r.width + width, width}, colour);
  rectangle({r.left - h, r.bottom - h, width, r.height + width}, colour);
  rectangle({r.right() - h, r.bottom - h, width, r.height + width}, colour);
}

void Canvas::line(const Point& a, const Point& b, double width, const Colour& colour) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
  if (!(length > 0))
    return;
  const double nx = -dy / length * width / 2, ny = dx / length * width / 2;
  polygon({{a[0] - nx, a[1] - ny}, {b[0] - nx, b[1] - ny}, {b[0] + nx, b[1] + ny}, {a[0] + nx, a[1] + ny}},
          colour);
}

void Canvas::polyline(const std::vector<Point>& points, double width, const Colour& colour, bool dashed) {
  const double dash = 4 * width, gap = 2.5 * width;
  double at = 0; // along the pattern
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point &a = points[i], &b = points[i + 1];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (!dashed) {
      line(a, b, width, colour);
      if (i > 0)
        disc(a, width / 2, colour);
      continue;
    }
    for (double s = 0; s < length;) {
      const double phase = std::fmod(at, dash + gap);
      const bool drawn = phase < dash;
      const double step = std::min(length - s, (drawn ? dash : dash + gap) - phase + 1e-9);
      const auto along = [&](double d) {
        return Point{a[0] + (b[0] - a[0]) * d / length, a[1] + (b[1] - a[1]) * d / length};
      };
      if (drawn)
        line(along(s), along(s + step), width, colour);
      s += step;
      at += step;
    }
  }
}

void Canvas::disc(const Point& centre, double radius, const Colour& colour) {
  std::vector<Point> corners;
  const int n = 32;
  for (int i = 0; i < n; ++i)
    corners.push_back(
        {centre[0] + radius * std::cos(2 * M_PI * i / n), centre[1] + radius * std::sin(2 * M_PI * i / n)});
  polygon(corners, colour);
}

void Canvas::arrow(const Point& a, const Point& b, double width, const Colour& colour) {
  const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
  if (!(length > 0))
    return;
  const double head = std::min(5 * width, 0.6 * length);
  const Point d = {(b[0] - a[0]) / length, (b[1] - a[1]) / length};
  const Point neck = {b[0] - head * d[0], b[1] - head * d[1]};
  line(a, neck, width, colour);
  const double half = 0.36 * head;
  polygon({{b[0], b[1]},
           {neck[0] - half * d[1], neck[1] + half * d[0]},
           {neck[0] + half * d[1], neck[1] - half * d[0]}},
          colour);
}

double Canvas::text_width(const std::string& markup, double size) const {
  double width = 0;
  for (const Run& run : runs_of(markup))
    width += run_width(run.text, supersampling * size * run.size);
  return width / supersampling;
}

double Canvas::widest(const std::vector<std::string>& texts, double size) const {
  double width = 0;
  for (const std::string& text : texts)
    width = std::max(width, text_width(text, size));
  return width;
}

void Canvas::text(const std::string& markup, const Point& anchor, double size, HorizontalAlign horizontal,
                  VerticalAlign vertical, const Colour& colour, double degrees) {
  const double width = text_width(markup, size);
  double x = horizontal == HorizontalAlign::left    ? 0
             : horizontal == HorizontalAlign::right ? -width
                                                    : -width / 2;
  const double baseline = vertical == VerticalAlign::baseline ? 0
                          : vertical == VerticalAlign::middle ? -digit_height / 2 * size
                                                              : -digit_height * size;
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  for (const Run& run : runs_of(markup)) {
    if (run.text.empty())
      continue;
    const double pixels = supersampling * size * run.size;
    vtkNew<vtkTextActor> actor;
    actor->SetInput(run.text.c_str());
    set_font(actor->GetTextProperty(), pixels);
    actor->GetTextProperty()->SetColor(colour[0], colour[1], colour[2]);
    actor->GetTextProperty()->SetOrientation(degrees);
    const double base = baseline + run.rise * size;
    impl_->written.push_back({run.text,
                              {anchor[0] + c * x - s * base, anchor[1] + s * x + c * base},
                              size * run.size,
                              degrees,
                              colour});
    const double y = base - descent * run.size * size; // lower edge of the line of text
    actor->SetPosition(std::round(supersampling * (anchor[0] + c * x - s * y)),
                       std::round(supersampling * (anchor[1] + s * x + c * y)));
    impl_->texts->AddActor(actor);
    x += run_width(run.text, pixels) / supersampling;
  }
}

VectorPage Canvas::page(const std::array<int, 2>& size) const {
  VectorPage page;
  page.size = size;
  page.shapes = impl_->flat;
  page.texts = impl_->written;
  return page;
}

std::vector<vtkRenderer*> Canvas::renderers(const std::array<int, 2>& size) {
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(impl_->points);
  mesh->SetPolys(impl_->cells);
  mesh->GetCellData()->SetScalars(impl_->colours);
  // Not vtkPolyDataMapper2D: where its shapes overlap the first one wins.
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh);
  mapper->SetColorModeToDirectScalars();
  mapper->SetScalarModeToUseCellData();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  impl_->shapes->AddActor(actor);
  vtkCamera* camera = impl_->shapes->GetActiveCamera();
  const double x = 0.5 * size[0], y = 0.5 * size[1];
  const double height = static_cast<double>(impl_->cells->GetNumberOfCells()) + 1;
  camera->SetParallelProjection(1);
  camera->SetParallelScale(y);
  camera->SetFocalPoint(x, y, 0);
  camera->SetPosition(x, y, height);
  camera->SetViewUp(0, 1, 0);
  camera->SetClippingRange(0.5, height + 0.5);
  return {impl_->shapes, impl_->texts};
}

} // namespace cdem
