// Cells of the Voronoi diagram in a box whose lower corner is the origin. Wraps voro++.
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

namespace geom {

struct VoronoiCell {
  Polyhedron shape;
  std::vector<int> neighbours; // per face: the seed beyond it, < 0 for a side of the box
};

// Cells of the seeds named in `wanted`, in that order. Lengths are best of the order of a cell's size: voro++
// has absolute tolerances. Throws InputError when two seeds coincide.
std::vector<VoronoiCell> voronoi_cells(const Vec3& box, const std::vector<Vec3>& seeds,
                                       const std::vector<int>& wanted);

} // namespace geom
