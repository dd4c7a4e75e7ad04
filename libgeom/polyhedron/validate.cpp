// What makes a polyhedron a block: closed, convex, flat faces, outward loops, Euler's V - E + F = 2.
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace geom {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("polyhedron: " + what);
}

void check_indices(const Polyhedron& p) {
  if (p.vertices.size() < 4 || p.faces.size() < 4)
    refuse("has " + std::to_string(p.vertices.size()) + " vertices and " + std::to_string(p.faces.size()) +
           " faces; a block needs at least 4 of each");
  for (std::size_t v = 0; v < p.vertices.size(); ++v)
    if (!p.vertices[v].allFinite())
      refuse("vertex " + std::to_string(v) + " = " + text(p.vertices[v]) + " is not finite");
  for (std::size_t f = 0; f < p.faces.size(); ++f) {
    const std::vector<int>& loop = p.faces[f].loop;
    if (loop.size() < 3)
      refuse("face " + std::to_string(f) + " has " + std::to_string(loop.size()) +
             " vertices; a face needs at least 3");
    for (int v : loop)
      if (v < 0 || v >= static_cast<int>(p.vertices.size()))
        refuse("face " + std::to_string(f) + " names vertex " + std::to_string(v) +
               ", which does not exist (0 to " + std::to_string(p.vertices.size() - 1) + ")");
    if (std::set<int>(loop.begin(), loop.end()).size() != loop.size())
      refuse("face " + std::to_string(f) + " passes a vertex twice; give each face one simple loop");
  }
}

// Each edge must be walked once in each direction; then the surface is closed and its faces agree on a side.
void check_closed(const Polyhedron& p) {
  std::vector<std::array<int, 2>> directed;
  for (const PolyhedronFace& face : p.faces)
    for (std::size_t i = 0; i < face.loop.size(); ++i)
      directed.push_back({face.loop[i], face.loop[(i + 1) % face.loop.size()]});
  std::sort(directed.begin(), directed.end());
  const auto name = [](const std::array<int, 2>& edge) {
    return "edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
  };
  const auto twice = std::adjacent_find(directed.begin(), directed.end());
  if (twice != directed.end())
    refuse(name(*twice) +
           " is walked twice in the same direction; list every face counter-clockwise from outside");
  for (const auto& [a, b] : directed)
    if (!std::binary_search(directed.begin(), directed.end(), std::array<int, 2>{b, a}))
      refuse(name({a, b}) + " has a face on one side only; the surface must be closed");
  const long v = static_cast<long>(p.vertices.size()), e = static_cast<long>(directed.size()) / 2,
             f = static_cast<long>(p.faces.size());
  if (v - e + f != 2)
    refuse("V - E + F = " + std::to_string(v) + " - " + std::to_string(e) + " + " + std::to_string(f) +
           " = " + std::to_string(v - e + f) + "; must be 2 (remove unused vertices, split separate pieces)");
}

} // namespace

void validate(const Polyhedron& p) {
  check_indices(p);
  check_closed(p);

  const Box box = bounding_box(p);
  const double size = box.size().norm();
  const double rounding = 16 * std::numeric_limits<double>::epsilon() *
                          std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  double surface = 0;
  for (std::size_t i = 0; i < p.faces.size(); ++i) {
    const int f = static_cast<int>(i);
    const std::string name = "face " + std::to_string(f);
    const std::vector<int>& loop = p.faces[i].loop;
    const double area = face_area(p, f);
    double perimeter = 0;
    for (std::size_t k = 0; k < loop.size(); ++k)
      perimeter += (p.vertices[loop[(k + 1) % loop.size()]] - p.vertices[loop[k]]).norm();
    if (!(area > 1e-14 * size * perimeter))
      refuse(name + " has no area");
    surface += area;
    // A narrow face fixes its plane only as well as its corners are rounded over its width.
    const double tolerance = 1e-9 * size + rounding * (1 + size * perimeter / area);
    const Plane plane = Plane::through(face_centroid(p, f), face_normal(p, f));
    for (int v : loop)
      if (std::abs(plane.level(p.vertices[v])) > tolerance)
        refuse(name + " is warped: vertex " + std::to_string(v) + " lies " +
               text(std::abs(plane.level(p.vertices[v]))) + " m off its plane; split it into flat faces");
    int outside = 0;
    for (std::size_t v = 0; v < p.vertices.size(); ++v)
      if (plane.level(p.vertices[v]) > tolerance)
        ++outside;
    if (outside > 0 && outside + loop.size() == p.vertices.size())
      refuse(name + " looks inward; list its vertices counter-clockwise seen from outside");
    if (outside > 0)
      refuse("is not convex: " + counted(outside, "vertex lies", "vertices lie") + " outside of " + name +
             "; split it into convex blocks");
  }
  const double volume = mass_properties(p).volume;
  if (!(volume > 1e-9 * size * surface))
    refuse("has a volume of " + text(volume) + " m3; must be > 0");
}

} // namespace geom
