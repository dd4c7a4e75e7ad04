// Whether the limits of this process leave the memory that a picture takes. Mesa and LLVM crash where they run out of it.
#pragma once

#include <array>
#include <stdexcept>

namespace cdem {

class NoRoomForPicture : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// Throws NoRoomForPicture, with the limit and what would do. pixels: width and height.
void require_room_for_picture(const std::array<int, 2>& pixels);
// What was taken for pixels has been given back.
void forget_kept_pixels();

} // namespace cdem
