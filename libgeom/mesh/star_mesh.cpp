#include "libgeom/mesh/star_mesh.hpp"

namespace geom {

BlockMesh star_mesh(const Polyhedron& p) {
  BlockMesh mesh;
  mesh.nodes = p.vertices;
  const int n_vertices = static_cast<int>(p.vertices.size()), n_faces = static_cast<int>(p.faces.size());
  for (int f = 0; f < n_faces; ++f)
    mesh.nodes.push_back(face_centroid(p, f));
  mesh.nodes.push_back(mass_properties(p).centroid);

  const int centroid = n_vertices + n_faces;
  mesh.fans.resize(n_faces);
  mesh.fan_tets.resize(n_faces);
  for (int f = 0; f < n_faces; ++f) {
    const std::vector<int>& loop = p.faces[f].loop;
    const int centre = n_vertices + f;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int start = loop[i], end = loop[(i + 1) % loop.size()];
      mesh.fans[f].push_back({centre, start, end});
      mesh.fan_tets[f].push_back(static_cast<int>(mesh.tets.size()));
      mesh.tets.push_back({centroid, centre, start, end});
    }
  }
  return mesh;
}

} // namespace geom
