// Size of the tets of a solid's mesh as a function of position.
#pragma once

#include "libgeom/core/types.hpp"

#include <vector>

namespace geom {

// Smaller tets near a point, a line or in a box: `size` up to `radius` from it, then growing with the
// distance.
struct Refinement {
  std::vector<Vec3> line; // m: one point, or a line through several; empty: box
  Box box;                // m
  double size = 0;        // m
  double radius = 0;      // m
};

struct MeshSize {
  double size = 0;     // edge length, m
  double growth = 0.3; // m of size per m of distance from a refinement
  std::vector<Refinement> refinements{};
};

// Throws InputError for sizes that are not positive and finite or refinements without a place.
void validate(const MeshSize&);

double size_at(const MeshSize&, const Vec3&);       // m: the smallest that anything asks for there
double distance_to(const Refinement&, const Vec3&); // m, 0 inside a box

// About how many tets of these sizes fill a box a share of which is solid.
double expected_tets(const MeshSize&, const Box&, double solid_volume);

} // namespace geom
