// Stereonet on white: poles and great circles of planes, equal-area, lower hemisphere (libgeom/core/stereonet.hpp).
#pragma once

#include "libcdem/vtk/picture.hpp"
#include "libgeom/core/stereonet.hpp"

namespace cdem {

struct StereonetPoles {
  std::string name;
  std::vector<geom::Orientation> planes;
  std::optional<Colour> colour = std::nullopt; // else the next of the palette
};

struct StereonetPlane {
  std::string name;
  geom::Orientation plane;
  bool dashed = false;
  // Else that of the poles of the same name, else the next of the palette after those of the poles.
  std::optional<Colour> colour = std::nullopt;
};

struct StereonetOptions {
  std::string title;
  std::array<int, 2> size = {1600, 1200}; // pixels
  double dpi = 300;                       // pixels in an inch of the printed net
};

// Writes a .png, .svg or .pdf. Throws geom::InputError for options that cannot be used, or when there is nothing to draw,
// std::runtime_error when the machine offers no off-screen OpenGL.
void stereonet(const std::vector<StereonetPoles>&, const std::vector<StereonetPlane>&,
               const StereonetOptions&, const std::string& path);

} // namespace cdem
