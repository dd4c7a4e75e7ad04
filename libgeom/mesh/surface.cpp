#include "libgeom/mesh/surface.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"

#include <algorithm>
#include <map>

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

namespace {

// Triangle counts by edge, from the corner with the smaller number.
std::map<std::array<int, 2>, int> edge_counts(const Surface& surface) {
  std::map<std::array<int, 2>, int> count;
  for (const Triangle& t : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      ++count[{low, high}];
    }
  return count;
}

} // namespace

std::vector<std::array<int, 2>> open_edges(const Surface& surface) {
  std::vector<std::array<int, 2>> open;
  for (const auto& [edge, count] : edge_counts(surface))
    if (count == 1)
      open.push_back(edge);
  return open;
}

void require_single(const Surface& surface, const std::string& field) {
  for (const auto& [edge, count] : edge_counts(surface))
    if (count > 2)
      throw InputError(field + ": must be one surface: " + std::to_string(count) +
                       " triangles overlap or meet in one edge near " +
                       place_text(0.5 * (surface.points[edge[0]] + surface.points[edge[1]])));
}

} // namespace geom
