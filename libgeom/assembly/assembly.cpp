#include "libgeom/assembly/assembly.hpp"

#include <set>

namespace geom {

Box bounding_box(const Assembly& assembly) {
  Box box;
  for (const Polyhedron& block : assembly.blocks)
    for (const Vec3& x : block.vertices)
      box.extend(x);
  return box;
}

std::vector<std::string> cut_names(const Assembly& assembly) {
  std::set<std::string> names;
  for (const Polyhedron& block : assembly.blocks)
    for (const PolyhedronFace& face : block.faces)
      if (!face.cut.empty())
        names.insert(face.cut);
  return {names.begin(), names.end()};
}

} // namespace geom
