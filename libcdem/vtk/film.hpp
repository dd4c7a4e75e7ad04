// A film from pictures of one size.
#pragma once

#include <string>
#include <vector>

namespace cdem {

// Ogg/Theora (.ogv), played by browsers and VLC; or H.264 (.mp4), which every player and slide program takes, where the
// program ffmpeg is installed. Throws geom::InputError when there is no frame, a frame cannot be read or frames differ
// in size, or ffmpeg is missing.
void write_film(const std::vector<std::string>& png_frames, int frames_per_second, const std::string& path);

} // namespace cdem
