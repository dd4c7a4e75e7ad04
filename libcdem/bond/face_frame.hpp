// A face between two sides that have parted or may part: its own axes, the mean of both sides, and the relative
// displacements at its three points, which are drawn in from its corners (weights 2/3, 1/6, 1/6).
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/parallel/triple.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <array>

namespace cdem {

inline constexpr double point_weight(int point, int corner) {
  return point == corner ? 2.0 / 3 : 1.0 / 6;
}

// Whether the two sides of a face have turned from each other by more than 60 degrees: their normals (any length), or their first
// edges. A bond that still holds at one of its points has torn then: that point stands for a third of the face, and around it the
// sides have parted by as much as the face is wide. Means of sides that have turned about have no direction.
template <class T>
CDEM_INLINE simd::MaskOf<T> turned_away(const Triple<T>& normal_a, const Triple<T>& normal_b,
                                        const Triple<T>& edge_a, const Triple<T>& edge_b) {
  const auto apart = [](const Triple<T>& a, const Triple<T>& b) __attribute__((always_inline)) {
    return simd::below<T>(dot(a, b), 0.5 * root(dot(a, a) * dot(b, b)));
  };
  return apart(normal_a, normal_b) | apart(edge_a, edge_b);
}

struct FaceFrame {
  std::array<geom::Vec3, 3> gap;    // m, from a to b, in space
  geom::Vec3 normal, along, across; // unit, the first edge in the plane
  bool torn = false;                // turned_away
  geom::Vec3 in_axes(const geom::Vec3& v) const { return {v.dot(along), v.dot(across), v.dot(normal)}; }
  geom::Vec3 in_space(const geom::Vec3& v) const { return v[0] * along + v[1] * across + v[2] * normal; }
};

// place(node), moved(node): m.
template <class Place, class Moved>
FaceFrame face_frame(const FaceNodes& at, const Place& place, const Moved& moved) {
  geom::Vec3 d[3];
  for (int k = 0; k < 3; ++k)
    d[k] = moved(at.b[k]) - moved(at.a[k]);
  const geom::Vec3 x0 = place(at.a[0]);
  const geom::Vec3 e1 = place(at.a[1]) - x0, e2 = place(at.a[2]) - x0;
  FaceFrame f;
  const geom::Vec3 edge_b = e1 + d[1] - d[0], normal_a = e1.cross(e2),
                   normal_b = edge_b.cross(e2 + d[2] - d[0]);
  f.torn = turned_away<double>(triple(normal_a), triple(normal_b), triple(e1), triple(edge_b));
  f.normal = (normal_a + normal_b).normalized();
  const geom::Vec3 edge = e1 + 0.5 * (d[1] - d[0]);
  f.along = (edge - edge.dot(f.normal) * f.normal).normalized();
  f.across = f.normal.cross(f.along);
  for (int k = 0; k < 3; ++k)
    f.gap[k] = (d[0] + d[1] + d[2]) / 6 + 0.5 * d[k];
  return f;
}

inline FaceNodes places_of(const FaceBatch& batch, int lane) { // of the chunk
  FaceNodes places;
  for (int k = 0; k < 3; ++k) {
    places.a[k] = batch.place_a[k][lane];
    places.b[k] = batch.place_b[k][lane];
  }
  return places;
}

// Where the face is now (behind: 0 s) or was that long ago, by what its nodes have done since.
inline FaceFrame face_frame(const FaceBatch& batch, int lane, const FaceMotion& m, double behind) {
  return face_frame(
      places_of(batch, lane),
      [&](int i) { return geom::Vec3(vec(m.position[i]) - behind * vec(m.velocity[i])); },
      [&](int i) { return geom::Vec3(vec(m.displacement[i]) - behind * vec(m.velocity[i])); });
}

inline FaceFrame face_frame(const FaceNodes& nodes, const Node* position, const Node* displacement) {
  return face_frame(
      nodes, [&](int i) { return vec(position[i]); }, [&](int i) { return vec(displacement[i]); });
}

} // namespace cdem
