#include "libgeom/assembly/assembly.hpp"

namespace geom {

Box bounding_box(const Assembly& assembly) {
  Box box;
  for (const Polyhedron& block : assembly.blocks)
    for (const Vec3& x : block.vertices)
      box.extend(x);
  return box;
}

} // namespace geom
