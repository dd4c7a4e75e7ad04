#include "libgeom/mesh/tet_quality.hpp"

#include "libgeom/core/portable.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>
#include <cmath>

namespace geom {

TetShape tet_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  TetShape shape;
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v);
  const double six_volumes = u.dot(vw);
  shape.volume = six_volumes / 6;
  const std::array<Vec3, 4> normal{(d - b).cross(c - b), vw, wu,
                                   uv}; // twice the area, outward but for a's sign
  double area = 0, largest = 0;         // twice the areas
  for (const Vec3& n : normal) {
    area += n.norm();
    largest = std::max(largest, n.norm());
  }
  const double volume = std::abs(shape.volume);
  if (!(volume > 0))
    return shape;
  const double inscribed = 6 * volume / area;
  const Vec3 to_centre =
      (u.squaredNorm() * vw + v.squaredNorm() * wu + w.squaredNorm() * uv) / (2 * six_volumes);
  shape.radius_ratio = 3 * inscribed / to_centre.norm();
  shape.min_height = 6 * volume / largest;
  // Between faces with outward normals m and n the dihedral angle is pi - angle(m, n).
  const std::array<Vec3, 4> outward{Vec3(-normal[0]), Vec3(-normal[1]), Vec3(-normal[2]), Vec3(-normal[3])};
  shape.min_dihedral = M_PI;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double angle = portable::atan2(outward[i].cross(outward[j]).norm(), -outward[i].dot(outward[j]));
      shape.min_dihedral = std::min(shape.min_dihedral, angle);
      shape.max_dihedral = std::max(shape.max_dihedral, angle);
    }
  return shape;
}

MeshQuality quality(const TetMesh& mesh) {
  MeshQuality q;
  q.nodes = mesh.nodes.size();
  q.tets = mesh.tets.size();
  q.outer_faces = outer_faces(mesh).size();
  if (mesh.tets.empty())
    return q;
  q.min_volume = q.min_radius_ratio = q.min_dihedral = q.min_height = q.min_edge =
      std::numeric_limits<double>::infinity();
  std::vector<std::array<int, 2>> edges;
  for (const Tet& tet : mesh.tets) {
    const TetShape s =
        tet_shape(mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]);
    q.volume += s.volume;
    q.min_volume = std::min(q.min_volume, s.volume);
    q.max_volume = std::max(q.max_volume, s.volume);
    q.mean_radius_ratio += s.radius_ratio / static_cast<double>(mesh.tets.size());
    q.min_radius_ratio = std::min(q.min_radius_ratio, s.radius_ratio);
    q.min_dihedral = std::min(q.min_dihedral, s.min_dihedral);
    q.max_dihedral = std::max(q.max_dihedral, s.max_dihedral);
    q.min_height = std::min(q.min_height, s.min_height);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        edges.push_back({std::min(tet[i], tet[j]), std::max(tet[i], tet[j])});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges) {
    const double length = (mesh.nodes[a] - mesh.nodes[b]).norm();
    q.min_edge = std::min(q.min_edge, length);
    q.max_edge = std::max(q.max_edge, length);
    q.mean_edge += length / static_cast<double>(edges.size());
  }
  return q;
}

} // namespace geom
