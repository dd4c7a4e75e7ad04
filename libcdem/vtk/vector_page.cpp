#include "libcdem/vtk/vector_page.hpp"

#include "libcdem/vtk/glyph_paths.hpp"

#include <vtkBase64Utilities.h>
#include <vtk_libharu.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace cdem {
namespace {

std::string number(double x) { // hundredths of a pixel
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", x);
  std::string short_text = text;
  short_text.erase(short_text.find_last_not_of('0') + 1);
  if (short_text.back() == '.')
    short_text.pop_back();
  return short_text == "-0" ? "0" : short_text;
}

std::string colour_text(const Colour& colour) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(std::lround(255 * colour[0])),
                static_cast<unsigned>(std::lround(255 * colour[1])),
                static_cast<unsigned>(std::lround(255 * colour[2])));
  return text;
}

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3), ' ');
  const auto length = vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(bytes.data()),
                                                 static_cast<unsigned long>(bytes.size()),
                                                 reinterpret_cast<unsigned char*>(text.data()), 0);
  text.resize(length);
  return text;
}

} // namespace

std::string svg_of(const VectorPage& page) {
  const double height = page.size[1], mm = 25.4 / page.dpi;
  const auto at = [&](const std::array<double, 2>& p) { // SVG's y points down
    return number(p[0]) + ' ' + number(height - p[1]);
  };
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
      number(mm * page.size[0]) + "mm\" height=\"" + number(mm * height) + "mm\" viewBox=\"0 0 " +
      std::to_string(page.size[0]) + ' ' + std::to_string(page.size[1]) +
      "\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  if (!page.png.empty())
    out += "<image width=\"" + std::to_string(page.size[0]) + "\" height=\"" + std::to_string(page.size[1]) +
           "\" href=\"data:image/png;base64," + base64(page.png) + "\"/>\n";
  for (const VectorShape& shape : page.shapes) {
    out += "<polygon fill=\"" + colour_text(shape.colour) + "\" points=\"";
    for (const auto& corner : shape.corners)
      out += (&corner == &shape.corners.front() ? "" : " ") + at(corner);
    out += "\"/>\n";
  }
  for (const VectorText& text : page.texts) {
    out += "<path fill=\"" + colour_text(text.colour) + "\" d=\"";
    bool open = false;
    for (const PathPiece& piece : glyph_path(text)) {
      if (piece.kind == PathPiece::move)
        out += (open ? "ZM" : "M") + at(piece.points[0]);
      else if (piece.kind == PathPiece::line)
        out += "L" + at(piece.points[0]);
      else
        out += "C" + at(piece.points[0]) + ' ' + at(piece.points[1]) + ' ' + at(piece.points[2]);
      open = true;
    }
    out += open ? "Z\"/>\n" : "\"/>\n";
  }
  return out + "</svg>\n";
}

std::string pdf_of(const VectorPage& page) {
  const std::unique_ptr<std::remove_pointer_t<HPDF_Doc>, void (*)(HPDF_Doc)> document(
      HPDF_New(nullptr, nullptr), [](HPDF_Doc d) { HPDF_Free(d); });
  if (!document)
    throw std::runtime_error("no PDF can be made: out of memory");
  HPDF_SetCompressionMode(document.get(), HPDF_COMP_ALL);
  HPDF_Page sheet = HPDF_AddPage(document.get());
  const double points = 72 / page.dpi; // of a page's 72 an inch, in a pixel
  HPDF_Page_SetWidth(sheet, static_cast<HPDF_REAL>(points * page.size[0]));
  HPDF_Page_SetHeight(sheet, static_cast<HPDF_REAL>(points * page.size[1]));
  const auto x = [&](const std::array<double, 2>& p) { return static_cast<HPDF_REAL>(points * p[0]); };
  const auto y = [&](const std::array<double, 2>& p) { return static_cast<HPDF_REAL>(points * p[1]); };
  const auto fill = [&](const Colour& c) {
    HPDF_Page_SetRGBFill(sheet, static_cast<HPDF_REAL>(c[0]), static_cast<HPDF_REAL>(c[1]),
                         static_cast<HPDF_REAL>(c[2]));
  };
  if (!page.png.empty()) {
    HPDF_Image image =
        HPDF_LoadPngImageFromMem(document.get(), reinterpret_cast<const HPDF_BYTE*>(page.png.data()),
                                 static_cast<HPDF_UINT>(page.png.size()));
    if (image)
      HPDF_Page_DrawImage(sheet, image, 0, 0, HPDF_Page_GetWidth(sheet), HPDF_Page_GetHeight(sheet));
  }
  for (const VectorShape& shape : page.shapes) {
    fill(shape.colour);
    for (const auto& corner : shape.corners)
      if (&corner == &shape.corners.front())
        HPDF_Page_MoveTo(sheet, x(corner), y(corner));
      else
        HPDF_Page_LineTo(sheet, x(corner), y(corner));
    HPDF_Page_ClosePath(sheet);
    HPDF_Page_Fill(sheet);
  }
  for (const VectorText& text : page.texts) {
    const std::vector<PathPiece> path = glyph_path(text);
    if (path.empty())
      continue;
    fill(text.colour);
    for (const PathPiece& piece : path) {
      const auto& p = piece.points;
      if (piece.kind == PathPiece::move)
        HPDF_Page_MoveTo(sheet, x(p[0]), y(p[0]));
      else if (piece.kind == PathPiece::line)
        HPDF_Page_LineTo(sheet, x(p[0]), y(p[0]));
      else
        HPDF_Page_CurveTo(sheet, x(p[0]), y(p[0]), x(p[1]), y(p[1]), x(p[2]), y(p[2]));
    }
    HPDF_Page_Fill(sheet);
  }
  if (HPDF_SaveToStream(document.get()) != HPDF_OK || HPDF_GetError(document.get()) != HPDF_OK)
    throw std::runtime_error("the PDF library fails with error " +
                             std::to_string(HPDF_GetErrorDetail(document.get())));
  std::string bytes(HPDF_GetStreamSize(document.get()), '\0');
  HPDF_ResetStream(document.get());
  auto size = static_cast<HPDF_UINT32>(bytes.size());
  HPDF_ReadFromStream(document.get(), reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
  bytes.resize(size);
  return bytes;
}

} // namespace cdem
