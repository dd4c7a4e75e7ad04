// Measures of a pile on a slope: porosity, units per area, thickness of the layer.
//
// Columns along the normal of the slope stand on a square grid over the middle of the pile: inside the convex hull of
// the units' centroids as seen along the normal and at least H/2 from its edge, about one unit from the edge of the
// pile. `thickness` is the mean height above the slope of the highest point that a column meets, over the columns that
// meet a unit. `porosity` is the part of the space between the slope and that height that no unit fills, over all
// columns. `units_per_area` is the volume of solid over the area, divided by that of a unit.
#pragma once

#include "libgeom/mesh/surface.hpp"

namespace geom {

struct PileMeasures {
  double area = 0;            // m2 of slope, that the columns stand for
  double porosity = 0;        // 1
  double porosity_error = 0;  // 1, change of the porosity when every second column is left out
  double units_per_area = 0;  // 1/m2
  double packing_density = 0; // phi = N Dn^2 / A, 1
  double thickness = 0;       // m
  std::int64_t columns = 0;
};

// Closed surfaces of the units where they are, and of the ground. H: height of a unit, m; unit_volume, m3. Throws
// InputError when the pile is too small to have a middle, or reaches beside the ground there.
PileMeasures measure_pile(const std::vector<Surface>& units, const Surface& ground, double height,
                          double unit_volume);

} // namespace geom
