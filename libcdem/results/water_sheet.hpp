// Water at one time, ready to be drawn or written: its free surface over a rectangle as triangles that end at the water
// line, and the heights of the same surface on a grid, with which pictures find where it cuts bodies. Plain arrays:
// results/free_surface makes it, vtk/ reads it.
#pragma once

#include "libgeom/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace cdem {

// What a picture or a file shows of the water that loads a model.
struct WaterWish {
  bool shown = true;                 // its free surface
  bool velocity = false;             // arrows: on the free surface, or in the section
  std::optional<geom::Vec3> point{}; // m, of a section; with its normal
  geom::Vec3 normal = geom::Vec3::Zero();
};

struct WaterArrow {
  geom::Vec3 place = geom::Vec3::Zero();    // m
  geom::Vec3 velocity = geom::Vec3::Zero(); // m/s
};

struct WaterSheet {
  std::vector<geom::Vec3> points;        // m, on the free surface
  std::vector<geom::Vec3> velocity;      // m/s, at the points
  std::vector<geom::Triangle> triangles; // over points, upwards
  std::vector<std::array<int, 2>> net;   // over points: every few lines of the grid, to be drawn as lines
  std::vector<std::array<int, 2>> shore; // over points: the water line on the bed that the field knows
  std::vector<WaterArrow> arrows;        // where they were wished

  // The grid: points i + j * size[0].
  std::array<double, 2> origin{0, 0}, cell{1, 1}; // m, x and y
  std::array<int, 2> size{0, 0};                  // points along x and y; 0: water without a free surface
  std::vector<double> height;                     // m, z; nan where it is dry

  // m, z of the surface, linear over the triangles of the grid; nan where a corner is dry, and outside the rectangle.
  double height_at(double x, double y) const {
    const double u = (x - origin[0]) / cell[0], v = (y - origin[1]) / cell[1];
    if (!(u >= -1e-9 && v >= -1e-9 && u <= size[0] - 1 + 1e-9 && v <= size[1] - 1 + 1e-9))
      return std::nan("");
    const int i = std::min(std::max(static_cast<int>(u), 0), size[0] - 2),
              j = std::min(std::max(static_cast<int>(v), 0), size[1] - 2);
    const double a = u - i, b = v - j;
    const auto at = [&](int di, int dj) {
      return height[static_cast<std::size_t>(i + di) + static_cast<std::size_t>(j + dj) * size[0]];
    };
    return a >= b ? at(0, 0) + a * (at(1, 0) - at(0, 0)) + b * (at(1, 1) - at(1, 0))
                  : at(0, 0) + b * (at(0, 1) - at(0, 0)) + a * (at(1, 1) - at(0, 1));
  }
};

} // namespace cdem
