// What pictures and charts have in common in their declarations.
#pragma once

#include "lua/binding/schema/schema.hpp"

#include "libcdem/vtk/picture.hpp"

#include <functional>

namespace cdem::script {

struct Session;

Field size_field(); // "size": {width, height} in pixels
Field dpi_field();
Field drawing_field(); // file
Field colour_field();  // "colour": {red, green, blue}

std::array<int, 2> size_of(const Arguments&, bool free_height = true); // free: 0, as high as needed
std::optional<Colour> colour_of(const Arguments&);
std::optional<std::array<double, 2>> limits_of(const Arguments&,
                                               const std::string& name); // {lowest, highest}

// What every picture takes: file, colour, where to look from, and what is written around the body.
// usual_up: the axis that is up where the script names none.
std::vector<Field> view_fields(const std::string& colour_doc, const std::string& usual_up);
PictureOptions view_options(const Arguments&);

// Draws a file of the output folder with the body. Where the memory for it is short the script goes on with a warning:
// a report must not be lost for a picture.
void draw(Session&, const std::string& file, const std::function<void(const std::string& path)>& body);

// Throws geom::InputError when a file name has another ending.
void require_ending(const std::string& file, const std::string& ending);
void require_drawing(const std::string& file); // .png, .svg or .pdf
void require_one_of(const std::string& file, const std::vector<std::string>& endings);

} // namespace cdem::script
