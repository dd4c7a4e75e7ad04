// Pictures of three blocks with nothing around them.
#pragma once

#include "libcdem/vtk/picture.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/sample.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace testing {

using namespace cdem;

// Three blocks side by side with a value each, and a point field that rises from 0 to 3 along x.
inline Snapshot three_blocks() {
  Snapshot s = sample::blocks(sample::grid(3, 1, 3, 1), 0.2);
  SnapshotField level{"level", "1", 1, {}, false}, rise{"rise", "1", 1, {}, false};
  for (const double id : s.cell_fields[0].values)
    level.values.push_back(id - 1);
  for (const geom::Vec3& x : s.points)
    rise.values.push_back(x.x());
  s.cell_fields.push_back(level);
  s.point_fields.push_back(rise);
  return s;
}

// Nothing but the body.
inline PictureOptions bare(const std::string& field) {
  PictureOptions o;
  o.field = field;
  o.colour_bar = o.edges = o.axes = o.legend = false;
  o.size = {400, 300};
  o.colour_map = "grey"; // 40 to 245 of 255
  return o;
}

inline std::array<int, 3> bytes(const Colour& c) {
  return {static_cast<int>(std::lround(255 * c[0])), static_cast<int>(std::lround(255 * c[1])),
          static_cast<int>(std::lround(255 * c[2]))};
}

inline int grey_at(const Image& image, double along) { // along the width of the body
  const Image::Bounds b = image.bounds();
  const auto c =
      image.at(static_cast<int>(std::lround(b.left + along * (b.right - b.left))), (b.bottom + b.top) / 2);
  CHECK(c[0] == c[1]);
  CHECK(c[1] == c[2]);
  return c[0];
}

} // namespace testing
