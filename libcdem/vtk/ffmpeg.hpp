// The program ffmpeg, where it is installed, as the writer of H.264.
#pragma once

#include <string>
#include <vector>

namespace cdem {

bool has_ffmpeg();

// Frames are PNG files of one size, which ffmpeg is handed over a pipe: it opens no file but the film. Returns what went
// wrong, its last line; empty: nothing.
std::string write_with_ffmpeg(const std::vector<std::string>& png_frames, int frames_per_second,
                              const std::string& path);

} // namespace cdem
