// Convex hull of points (CGAL), its coplanar triangles joined into polygons.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <map>
#include <string>

namespace geom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HullMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// How far the points spread along their first, second and third direction, m.
Vec3 spread(const std::vector<Vec3>& points) {
  const Vec3& origin = points[0];
  const auto farthest = [&](auto distance) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  };
  const auto from_origin = [&](const Vec3& x) { return (x - origin).norm(); };
  const Vec3 end = farthest(from_origin);
  const double length = from_origin(end);
  if (!(length > 0))
    return Vec3::Zero();
  const Vec3 along = (end - origin) / length;
  const auto from_line = [&](const Vec3& x) { return (x - origin).cross(along).norm(); };
  const Vec3 aside = farthest(from_line);
  if (!(from_line(aside) > 0))
    return {length, 0, 0};
  const Vec3 normal = along.cross(aside - origin).normalized();
  const auto from_plane = [&](const Vec3& x) { return std::abs(normal.dot(x - origin)); };
  return {length, from_line(aside), from_plane(farthest(from_plane))};
}

struct Hull {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 3>> beyond; // triangle across the edge from corner k to k + 1
};

// CGAL's order follows from addresses, which differ between two processes. Here points stand in the order in which they are
// given, and triangles in that of their corners, of which the first comes first.
Hull triangulated(const std::vector<Vec3>& points) {
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const Vec3& x : points)
    input.emplace_back(x.x(), x.y(), x.z());
  HullMesh mesh;
  CGAL::convex_hull_3(input.begin(), input.end(), mesh);
  std::map<Kernel::Point_3, std::size_t> given; // the first of equal points
  for (std::size_t i = 0; i < input.size(); ++i)
    given.emplace(input[i], i);
  std::map<std::size_t, HullMesh::Vertex_index> in_order;
  for (const auto v : mesh.vertices())
    in_order.emplace(given.at(mesh.point(v)), v);
  Hull hull;
  std::vector<int> number(mesh.number_of_vertices()); // in the hull, by number in the mesh
  for (const auto& [i, v] : in_order) {
    number[v] = static_cast<int>(hull.points.size());
    hull.points.push_back(points[i]);
  }
  for (const auto f : mesh.faces()) {
    Triangle t;
    int k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      t[k++] = number[v];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    hull.triangles.push_back(t);
  }
  std::sort(hull.triangles.begin(), hull.triangles.end());
  std::map<std::array<int, 2>, int> owner; // directed edge -> triangle
  for (std::size_t t = 0; t < hull.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      owner[{hull.triangles[t][k], hull.triangles[t][(k + 1) % 3]}] = static_cast<int>(t);
  for (const Triangle& t : hull.triangles)
    hull.beyond.push_back({owner.at({t[1], t[0]}), owner.at({t[2], t[1]}), owner.at({t[0], t[2]})});
  return hull;
}

// Number of the flat region each triangle belongs to, grown from the largest triangles, whose planes are
// surest.
std::vector<int> flat_regions(const Hull& hull, double tolerance) {
  std::vector<Vec3> twice_area;
  std::vector<int> order;
  for (const Triangle& t : hull.triangles) {
    order.push_back(static_cast<int>(twice_area.size()));
    twice_area.push_back(
        (hull.points[t[1]] - hull.points[t[0]]).cross(hull.points[t[2]] - hull.points[t[0]]));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return twice_area[a].norm() > twice_area[b].norm(); });
  std::vector<int> region(hull.triangles.size(), -1);
  int regions = 0;
  for (int seed : order) {
    if (region[seed] >= 0)
      continue;
    const Plane plane = Plane::through(hull.points[hull.triangles[seed][0]], twice_area[seed]);
    std::vector<int> front{seed};
    region[seed] = regions;
    while (!front.empty()) {
      const int t = front.back();
      front.pop_back();
      for (int next : hull.beyond[t]) {
        const Triangle& corners = hull.triangles[next];
        if (region[next] < 0 && std::all_of(corners.begin(), corners.end(), [&](int v) {
              return std::abs(plane.level(hull.points[v])) <= tolerance;
            })) {
          region[next] = regions;
          front.push_back(next);
        }
      }
    }
    ++regions;
  }
  return region;
}

Polyhedron polygons(const Hull& hull, const std::vector<int>& region) {
  const int regions = *std::max_element(region.begin(), region.end()) + 1;
  std::vector<std::map<int, int>> next(regions); // rim of each region: vertex -> vertex
  std::vector<int> rims(hull.points.size(), 0);  // regions whose rim passes the vertex
  for (std::size_t t = 0; t < hull.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (region[hull.beyond[t][k]] != region[t]) {
        next[region[t]][hull.triangles[t][k]] = hull.triangles[t][(k + 1) % 3];
        ++rims[hull.triangles[t][k]];
      }
  // A vertex of fewer than three polygons is a point inside a face or on an edge, not a corner.
  Polyhedron p;
  std::vector<int> number(hull.points.size(), -1);
  for (std::size_t v = 0; v < hull.points.size(); ++v)
    if (rims[v] >= 3) {
      number[v] = static_cast<int>(p.vertices.size());
      p.vertices.push_back(hull.points[v]);
    }
  for (const auto& rim : next) {
    PolyhedronFace face;
    int v = rim.begin()->first;
    do {
      if (number[v] >= 0)
        face.loop.push_back(number[v]);
      v = rim.at(v);
    } while (v != rim.begin()->first);
    if (face.loop.size() >= 3)
      p.faces.push_back(std::move(face));
  }
  // Regions follow from triangles, and several triangulations of one flat face may be the hull.
  std::sort(p.faces.begin(), p.faces.end(),
            [](const PolyhedronFace& a, const PolyhedronFace& b) { return a.loop < b.loop; });
  return p;
}

} // namespace

Polyhedron convex_hull(const std::vector<Vec3>& points) {
  if (points.size() < 4)
    throw InputError("points", counted(points.size(), "point"), "at least 4 points");
  for (std::size_t i = 0; i < points.size(); ++i)
    require_finite("points[" + std::to_string(i + 1) + "]", points[i]);
  const Vec3 extent = spread(points);
  if (!(extent.z() > 1e-8 * extent.x()))
    throw InputError(
        "points", "a set of " + text(extent.x()) + " x " + text(extent.y()) + " x " + text(extent.z()) + " m",
        "points that are not in one plane", "add a point off the plane");
  const Hull hull = triangulated(points);
  double largest = 0;
  for (const Vec3& x : hull.points)
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  const double tolerance = 1e-10 * extent.x() + 8 * std::numeric_limits<double>::epsilon() * largest;
  Polyhedron p = polygons(hull, flat_regions(hull, tolerance));
  validate(p);
  return p;
}

} // namespace geom
