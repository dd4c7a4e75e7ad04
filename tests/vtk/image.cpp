#include "tests/vtk/image.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

int Image::count(const std::array<int, 3>& colour, int tolerance) const {
  int n = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto c = at(x, y);
      n += std::abs(c[0] - colour[0]) <= tolerance && std::abs(c[1] - colour[1]) <= tolerance &&
           std::abs(c[2] - colour[2]) <= tolerance;
    }
  return n;
}

int Image::ink() const {
  return width * height - count({255, 255, 255}, 0);
}

Image::Bounds Image::bounds() const {
  Bounds b{width, height, -1, -1};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (!white(x, y))
        b = {std::min(b.left, x), std::min(b.bottom, y), std::max(b.right, x), std::max(b.top, y)};
  return b;
}

Image read_png(const std::string& path) {
  vtkNew<vtkPNGReader> reader;
  if (!reader->CanReadFile(path.c_str()))
    throw std::runtime_error("not a PNG: " + path);
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* data = reader->GetOutput();
  if (data->GetNumberOfScalarComponents() != 3)
    throw std::runtime_error("not red, green, blue: " + path);
  Image image;
  image.width = data->GetDimensions()[0];
  image.height = data->GetDimensions()[1];
  const auto* bytes = static_cast<const unsigned char*>(data->GetScalarPointer());
  image.bytes.assign(bytes, bytes + 3 * static_cast<std::size_t>(image.width) *
                                        static_cast<std::size_t>(image.height));
  return image;
}
