// Colours of numbers and ids.
#pragma once

#include "libcdem/vtk/picture.hpp"

namespace cdem {

const std::vector<std::string>& colour_map_names(); // without "auto"
bool diverging(const std::string& colour_map);      // has a middle that stands for zero

// Colour at place in 0 .. 1 of a continuous map.
Colour map_colour(const std::string& colour_map, double place);

// Numbers to colours.
struct ColourScale {
  std::string map;          // a name of colour_map_names()
  double low = 0, high = 1; // SI; values outside take the colour of the end
  // SI, lowest and highest value, where a few far ones are outside the range that was chosen for the others
  std::optional<std::array<double, 2>> all = {};
  Colour operator()(double value) const; // light grey for NaN
};

// The map and range for `values`: see PictureOptions::colour_map and range. Throws geom::InputError for an
// unknown map or a range that is empty or not finite.
ColourScale colour_scale(const std::vector<double>& values, bool id, const std::string& colour_map,
                         const std::optional<std::array<double, 2>>& range);

// One of a few well separated colours for lines and small sets of ids; after eight they come darker, then lighter, and repeat after 24.
Colour palette_colour(std::size_t index);

// A light colour for any id, so that neighbouring ids differ and dark outlines stay visible.
Colour id_colour(std::int64_t id);

} // namespace cdem
