// A PNG read back, for tests that look at pixels.
#pragma once

#include <array>
#include <string>
#include <vector>

struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> bytes; // red green blue, rows from the bottom

  // x from the left, y from the bottom
  std::array<int, 3> at(int x, int y) const {
    const std::size_t i =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {bytes[i], bytes[i + 1], bytes[i + 2]};
  }
  bool white(int x, int y) const { return at(x, y) == std::array<int, 3>{255, 255, 255}; }
  int count(const std::array<int, 3>& colour, int tolerance) const;
  int ink() const; // pixels that are not white

  struct Bounds {
    int left, bottom, right, top; // of all that is not white
  };
  Bounds bounds() const;
};

Image read_png(const std::string& path);
