#include "libgeom/polyhedron/common_part.hpp"

#include <algorithm>

namespace geom {
namespace {

// Over the size of the region: planes that agree to this are one.
constexpr double same_plane = 1e-13;

// The part of a convex polygon below a plane.
void clip(std::vector<Vec3>& polygon, const Plane& plane, std::vector<Vec3>& rest) {
  rest.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = plane.level(a), to = plane.level(b);
    if (from <= 0)
      rest.push_back(a);
    if ((from < 0 && to > 0) || (from > 0 && to < 0))
      rest.push_back(a + from / (from - to) * (b - a));
  }
  std::swap(polygon, rest);
}

} // namespace

std::vector<Plane> face_planes(const Polyhedron& shape) {
  std::vector<Plane> planes;
  planes.reserve(shape.faces.size());
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f)
    planes.push_back(Plane::through(shape.vertices[shape.faces[f].loop.front()], face_normal(shape, f)));
  return planes;
}

bool apart(const std::vector<Plane>& planes, const Polyhedron& other, double depth) {
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    return std::all_of(other.vertices.begin(), other.vertices.end(),
                       [&](const Vec3& x) { return plane.level(x) >= -depth; });
  });
}

CommonPart common_part(const std::vector<Plane>& one, const std::vector<Plane>& other, const Box& region) {
  const Vec3 centre = region.centre(); // all lengths are measured from here
  const double size = region.size().norm();
  std::vector<Plane> planes;
  for (const std::vector<Plane>* const of : {&one, &other})
    for (const Plane& plane : *of) {
      const Plane here{plane.normal, -plane.level(centre)};
      if (std::none_of(planes.begin(), planes.end(), [&](const Plane& p) {
            return (p.normal - here.normal).norm() <= same_plane &&
                   std::abs(p.offset - here.offset) <= same_plane * size;
          }))
        planes.push_back(here);
    }
  CommonPart part;
  std::vector<Vec3> polygon, rest;
  for (const Plane& plane : planes) {
    const Vec3 foot = plane.offset * plane.normal, u = size * plane.normal.unitOrthogonal(),
               v = plane.normal.cross(u);
    polygon = {foot - u - v, foot + u - v, foot + u + v, foot - u + v};
    for (const Plane& by : planes)
      if (&by != &plane && !polygon.empty())
        clip(polygon, by, rest);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const double pyramid = // a tetrahedron from the centre
          polygon[0].dot(polygon[i - 1].cross(polygon[i])) / 6;
      part.volume += pyramid;
      part.centroid += pyramid / 4 * (polygon[0] + polygon[i - 1] + polygon[i]);
    }
  }
  if (!(part.volume > 0))
    return {};
  part.centroid = centre + part.centroid / part.volume;
  return part;
}

} // namespace geom
