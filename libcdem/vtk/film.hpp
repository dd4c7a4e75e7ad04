// A film from pictures of one size.
#pragma once

#include <string>
#include <vector>

namespace cdem {

// Ogg/Theora, played by browsers and VLC. Throws geom::InputError when there is no frame, a frame cannot be
// read or frames differ in size.
void write_film(const std::vector<std::string>& png_frames, int frames_per_second,
                const std::string& ogv_path);

} // namespace cdem
