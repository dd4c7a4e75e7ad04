// Areas, centroids and mass properties by fans of triangles and tets about a corner of the block itself.
#include "libgeom/polyhedron/polyhedron.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cassert>

namespace geom {
namespace {

// Twice the area vector of a closed loop, summed about its own first vertex.
Vec3 twice_area_vector(const Polyhedron& p, const std::vector<int>& loop) {
  const Vec3& origin = p.vertices[loop[0]];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    sum += (p.vertices[loop[i]] - origin).cross(p.vertices[loop[i + 1]] - origin);
  return sum;
}

} // namespace

std::vector<std::array<int, 2>> edges(const Polyhedron& p) {
  std::vector<std::array<int, 2>> result;
  for (const PolyhedronFace& face : p.faces)
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
      const int a = face.loop[i], b = face.loop[(i + 1) % face.loop.size()];
      result.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

Vec3 face_normal(const Polyhedron& p, int face) {
  return twice_area_vector(p, p.faces[face].loop).normalized();
}

double face_area(const Polyhedron& p, int face) {
  return 0.5 * twice_area_vector(p, p.faces[face].loop).norm();
}

Vec3 face_centroid(const Polyhedron& p, int face) {
  const std::vector<int>& loop = p.faces[face].loop;
  const Vec3 normal = twice_area_vector(p, loop).normalized();
  const Vec3& origin = p.vertices[loop[0]];
  Vec3 moment = Vec3::Zero();
  double area = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec3 a = p.vertices[loop[i]] - origin, b = p.vertices[loop[i + 1]] - origin;
    const double twice = a.cross(b).dot(normal);
    moment += twice * (a + b);
    area += twice;
  }
  return origin + moment / (3 * area);
}

Box bounding_box(const Polyhedron& p) {
  Box box;
  for (const Vec3& x : p.vertices)
    box.extend(x);
  return box;
}

Polyhedron make_box(const Vec3& min, const Vec3& max) {
  assert((max.array() > min.array()).all());
  Polyhedron p;
  p.vertices = {{min.x(), min.y(), min.z()}, {max.x(), min.y(), min.z()}, {max.x(), max.y(), min.z()},
                {min.x(), max.y(), min.z()}, {min.x(), min.y(), max.z()}, {max.x(), min.y(), max.z()},
                {max.x(), max.y(), max.z()}, {min.x(), max.y(), max.z()}};
  p.faces = {{{0, 4, 7, 3}}, {{1, 2, 6, 5}}, {{0, 1, 5, 4}}, {{3, 7, 6, 2}}, {{0, 3, 2, 1}}, {{4, 5, 6, 7}}};
  return p;
}

MassProperties mass_properties(const Polyhedron& p) {
  // Every tet is the origin vertex and a triangle (a, b, c) of a face's fan. Over such a tet
  //   int x dV = V/4 (a + b + c),   int x xT dV = V/20 (a aT + b bT + c cT + s sT),  s = a + b + c.
  const Vec3& origin = p.vertices[0];
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const PolyhedronFace& face : p.faces) {
    const Vec3 a = p.vertices[face.loop[0]] - origin;
    for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
      const Vec3 b = p.vertices[face.loop[i]] - origin, c = p.vertices[face.loop[i + 1]] - origin;
      const double v = a.dot(b.cross(c)) / 6;
      const Vec3 s = a + b + c;
      volume += v;
      first += v / 4 * s;
      second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
  }
  const Vec3 centroid = first / volume;
  second -= volume * centroid * centroid.transpose();
  return {volume, origin + centroid, second.trace() * Mat3::Identity() - second};
}

double principal_inertia_ratio(const MassProperties& m) {
  const Vec3 moments =
      Eigen::SelfAdjointEigenSolver<Mat3>(m.inertia, Eigen::EigenvaluesOnly).eigenvalues(); // ascending
  return moments[2] / moments[0];
}

} // namespace geom
