// Distance from a point to a triangulated surface, by a tree of boxes (each half of the triangles of the one above it).
#pragma once

#include "libgeom/core/types.hpp"

#include <vector>

namespace cdem::field {

class SurfaceDistance {
public:
  using Corners = std::array<geom::Vec3, 3>;
  explicit SurfaceDistance(std::vector<Corners> triangles);
  double operator()(const geom::Vec3& x) const; // m; infinite without triangles

private:
  struct Part { // triangles [begin, end); its halves are `left` and `left` + 1, -1: none
    geom::Box box;
    int begin = 0, end = 0, left = -1;
  };
  void split(int part);
  void look(int part, const geom::Vec3& x, double& least2) const;

  std::vector<Corners> triangles_;
  std::vector<Part> parts_;
};

} // namespace cdem::field
