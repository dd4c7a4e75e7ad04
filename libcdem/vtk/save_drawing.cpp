#include "libcdem/vtk/save_drawing.hpp"

#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/offscreen.hpp"
#include "libcdem/vtk/png_resolution.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <fstream>

namespace cdem {
namespace {

std::string ending_of(const std::string& path) {
  for (const char* ending : {".png", ".svg", ".pdf"})
    if (path.size() > 4 && path.compare(path.size() - 4, 4, ending) == 0)
      return ending;
  throw geom::InputError("file", '"' + path + '"', "a name ending in .png, .svg or .pdf");
}

} // namespace

void check_drawing(const std::array<int, 2>& size, double dpi) {
  check_picture_size(size);
  geom::require_between("dpi", dpi, 10, 2400);
}

void check_drawing(const std::array<int, 2>& size, double dpi, const std::string& path) {
  check_drawing(size, dpi);
  ending_of(path);
  const AtomicFile probe(path); // the folder exists
}

std::string png_of_drawing(const std::array<int, 2>& size, double dpi, std::vector<vtkRenderer*> layers,
                           Canvas& canvas) {
  const bool flat = layers.empty();
  for (vtkRenderer* layer : canvas.renderers(size))
    layers.push_back(layer);
  return with_resolution(flat ? flat_png_of(size, layers) : png_of(size, layers), dpi);
}

void save_drawing(const std::array<int, 2>& size, double dpi, const std::vector<vtkRenderer*>& below,
                  Canvas& canvas, const std::string& path) {
  const std::string ending = ending_of(path);
  std::string bytes;
  if (ending == ".png") {
    bytes = png_of_drawing(size, dpi, below, canvas);
  } else {
    VectorPage page = canvas.page(size);
    page.dpi = dpi;
    if (!below.empty())
      page.png = png_of(size, below);
    bytes = ending == ".svg" ? svg_of(page) : pdf_of(page);
  }
  AtomicFile file(path);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream)
    file.refuse();
  file.commit();
}

} // namespace cdem
