#include "libgeom/solid/read_stl.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/solid/read_surface.hpp"

#include <map>

namespace geom {
namespace {

// One closed, orientable surface: each edge is run through once each way, and all triangles hang together.
void require_closed(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                    const std::string& path) {
  std::map<std::array<int, 2>, int> owner; // triangle by directed edge
  const auto near = [&](int a, int b) { return " near " + place_text(0.5 * (vertices[a] + vertices[b])); };
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      if (!owner.emplace(std::array<int, 2>{a, b}, static_cast<int>(t)).second)
        throw InputError("file", '"' + path + '"', "one closed surface",
                         "triangles overlap or point different ways" + near(a, b));
    }
  std::size_t open = 0;
  std::array<int, 2> first{};
  for (const auto& [edge, triangle] : owner)
    if (owner.count({edge[1], edge[0]}) == 0 && open++ == 0)
      first = edge;
  if (open > 0)
    throw InputError("file", '"' + path + '"', "one closed surface",
                     "it is open: " +
                         counted(open, "edge belongs to one triangle only,",
                                 "edges belong to one triangle only, the first") +
                         near(first[0], first[1]) + "; cdem.shell_mesh makes a wall of an open surface");
  std::vector<char> reached(triangles.size(), 0);
  std::vector<int> stack{0};
  reached[0] = 1;
  std::size_t together = 1;
  while (!stack.empty()) {
    const Triangle t = triangles[stack.back()];
    stack.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const int other = owner.at({t[(i + 1) % 3], t[i]});
      if (!reached[other]) {
        reached[other] = 1;
        ++together;
        stack.push_back(other);
      }
    }
  }
  if (together != triangles.size())
    throw InputError("file", '"' + path + '"', "one closed surface",
                     "it holds several; save each as a file of its own");
}

} // namespace

FacetedSurface read_stl(const std::string& path, double scale, const Vec3& shift, std::string* mended) {
  const FileSurface file = read_surface(path, scale, max_stl_triangles, shift);
  const Surface& read = file.surface;
  if (mended != nullptr)
    *mended = file.mended;
  FacetedSurface surface;
  surface.vertices = read.points;
  if (read.triangles.size() < 4)
    throw InputError("file", '"' + path + '"', "one closed surface",
                     "it has " + counted(read.triangles.size(), "triangle"));
  require_closed(surface.vertices, read.triangles, path);
  const Vec3 origin = bounding_box(read).min;
  double volume = 0;
  for (const Triangle& t : read.triangles)
    volume += (surface.vertices[t[0]] - origin)
                  .dot((surface.vertices[t[1]] - origin).cross(surface.vertices[t[2]] - origin)) /
              6;
  for (const Triangle& t : read.triangles)
    surface.faces.push_back(
        {volume > 0 ? std::vector<int>{t[0], t[1], t[2]} : std::vector<int>{t[0], t[2], t[1]}});
  return surface;
}

} // namespace geom
