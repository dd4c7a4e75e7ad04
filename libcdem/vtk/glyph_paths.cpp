#include "libcdem/vtk/glyph_paths.hpp"

#include "libcdem/vtk/canvas.hpp"

#include <cmath>
#include <ft2build.h>
#include <stdexcept>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace cdem {
namespace {

using Point = std::array<double, 2>;

// The font, for as long as the process lives; one thread at a time, as all drawing.
FT_Face face() {
  static const FT_Face the_face = [] {
    FT_Library library = nullptr;
    FT_Face opened = nullptr;
    if (FT_Init_FreeType(&library) != 0 || FT_New_Face(library, font_file().c_str(), 0, &opened) != 0)
      throw std::runtime_error(font_file() + " cannot be read as a font");
    return opened;
  }();
  return the_face;
}

std::vector<char32_t> letters_of(const std::string& text) { // UTF-8; a damaged letter is left out
  std::vector<char32_t> letters;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t bytes = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    char32_t letter = first & (bytes == 1 ? 0x7fu : 0xffu >> (bytes + 1));
    for (std::size_t k = 1; k < bytes && i + k < text.size(); ++k)
      letter = (letter << 6) | (static_cast<unsigned char>(text[i + k]) & 0x3fu);
    if (i + bytes <= text.size())
      letters.push_back(letter);
    i += bytes;
  }
  return letters;
}

struct Pen {
  const VectorText& text;
  double scale = 1, along = 0; // pixels a unit of the font; where the letter begins, in units of the font
  Point last{};                // in units of the font, of the letter
  std::vector<PathPiece> pieces{};

  Point place(const Point& p) const {
    const double c = std::cos(text.degrees * M_PI / 180), s = std::sin(text.degrees * M_PI / 180),
                 x = scale * (along + p[0]), y = scale * p[1];
    return {text.at[0] + c * x - s * y, text.at[1] + s * x + c * y};
  }
};

Point point(const FT_Vector* v) {
  return {static_cast<double>(v->x), static_cast<double>(v->y)};
}

int move_to(const FT_Vector* to, void* user) {
  auto& pen = *static_cast<Pen*>(user);
  pen.last = point(to);
  pen.pieces.push_back({PathPiece::move, {pen.place(pen.last)}});
  return 0;
}
int line_to(const FT_Vector* to, void* user) {
  auto& pen = *static_cast<Pen*>(user);
  pen.last = point(to);
  pen.pieces.push_back({PathPiece::line, {pen.place(pen.last)}});
  return 0;
}
int cubic_to(const FT_Vector* a, const FT_Vector* b, const FT_Vector* to, void* user) {
  auto& pen = *static_cast<Pen*>(user);
  pen.last = point(to);
  pen.pieces.push_back({PathPiece::cubic, {pen.place(point(a)), pen.place(point(b)), pen.place(pen.last)}});
  return 0;
}
int conic_to(const FT_Vector* control, const FT_Vector* to, void* user) { // as the cubic curve that it is
  auto& pen = *static_cast<Pen*>(user);
  const Point c = point(control), end = point(to), start = pen.last;
  const auto towards = [&](const Point& from) {
    return Point{from[0] + 2. / 3 * (c[0] - from[0]), from[1] + 2. / 3 * (c[1] - from[1])};
  };
  pen.pieces.push_back(
      {PathPiece::cubic, {pen.place(towards(start)), pen.place(towards(end)), pen.place(end)}});
  pen.last = end;
  return 0;
}

} // namespace

std::vector<PathPiece> glyph_path(const VectorText& text) {
  const FT_Face font = face();
  Pen pen{text, text.size / font->units_per_EM};
  FT_Outline_Funcs functions{move_to, line_to, conic_to, cubic_to, 0, 0};
  FT_UInt before = 0;
  for (const char32_t letter : letters_of(text.text)) {
    const FT_UInt glyph = FT_Get_Char_Index(font, letter);
    if (FT_Load_Glyph(font, glyph, FT_LOAD_NO_SCALE) != 0)
      continue;
    FT_Vector kerning{0, 0};
    if (before != 0 && FT_HAS_KERNING(font))
      FT_Get_Kerning(font, before, glyph, FT_KERNING_UNSCALED, &kerning);
    pen.along += static_cast<double>(kerning.x);
    FT_Outline_Decompose(&font->glyph->outline, &functions, &pen);
    pen.along += static_cast<double>(font->glyph->advance.x);
    before = glyph;
  }
  return std::move(pen.pieces);
}

} // namespace cdem
