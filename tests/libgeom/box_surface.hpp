// Boxes as surfaces, for tests of bodies that come to rest.
#pragma once

#include "libgeom/mesh/box_mesh.hpp"

namespace testing {

inline geom::Surface box_surface(const geom::Vec3& size, const geom::Vec3& centre = geom::Vec3::Zero()) {
  geom::Surface surface = geom::surface_of(geom::box_mesh(size, {2, 2, 2}));
  for (geom::Vec3& x : surface.points)
    x += centre - 0.5 * size;
  return surface;
}

} // namespace testing
