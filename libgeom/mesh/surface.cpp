#include "libgeom/mesh/surface.hpp"

#include "libgeom/mesh/boundary.hpp"

namespace geom {

Surface surface_of(const TetMesh& mesh) {
  Surface surface;
  std::vector<int> place(mesh.nodes.size(), -1);
  for (const OuterFace& face : outer_faces(mesh)) {
    Triangle triangle{};
    for (int i = 0; i < 3; ++i) {
      int& point = place[face.nodes[i]];
      if (point < 0) {
        point = static_cast<int>(surface.points.size());
        surface.points.push_back(mesh.nodes[face.nodes[i]]);
      }
      triangle[i] = point;
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

Box bounding_box(const Surface& surface) {
  Box box;
  for (const Vec3& x : surface.points)
    box.extend(x);
  return box;
}

} // namespace geom
