#include "libcdem/vtk/mesh_snapshot.hpp"

#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/outline.hpp"
#include "libgeom/mesh/tet_quality.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

Snapshot mesh_snapshot(const geom::TetMesh& mesh, const NamedFaces& named, double crease) {
  Snapshot snapshot;
  snapshot.points = mesh.nodes;
  snapshot.tets = mesh.tets;
  SnapshotField region{"region", "", 1, {mesh.region.begin(), mesh.region.end()}, true};
  for (double& number : region.values)
    number += 1; // users count from 1
  SnapshotField ratio{"radius_ratio", "1", 1, {}, false}, dihedral{"min_dihedral", "deg", 1, {}, false},
      volume{"volume", "m3", 1, {}, false};
  for (const geom::Tet& t : mesh.tets) {
    const geom::TetShape shape =
        geom::tet_shape(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]);
    ratio.values.push_back(shape.radius_ratio);
    dihedral.values.push_back(shape.min_dihedral * 180 / M_PI);
    volume.values.push_back(shape.volume);
  }
  snapshot.cell_fields = {region, ratio, dihedral, volume};
  const std::vector<geom::OuterFace> faces = geom::outer_faces(mesh);
  for (const auto& [name, chosen] : named) {
    SnapshotField on{"on_" + name, "", 1, std::vector<double>(mesh.nodes.size(), 0.), true};
    for (const int face : chosen)
      for (const int node : faces[face].nodes)
        on.values[node] = 1;
    snapshot.point_fields.push_back(on);
  }
  find_surface(snapshot, crease);
  return snapshot;
}

void set_apart(Snapshot& snapshot, const std::vector<geom::OuterFace>& faces, const NamedFaces& named) {
  std::map<geom::Triangle, std::size_t> place; // in the surface, by nodes
  for (std::size_t i = 0; i < snapshot.surface.size(); ++i)
    place[snapshot.surface[i]] = i;
  std::map<std::size_t, std::array<int, 3>> own; // points by place in the surface
  for (const auto& [name, chosen] : named)
    for (const int face : chosen) {
      const auto at = place.find(faces[face].nodes);
      if (at == place.end() || own.count(at->second) > 0)
        continue;
      std::array<int, 3>& points = own[at->second];
      for (std::size_t c = 0; c < 3; ++c) {
        points[c] = static_cast<int>(snapshot.points.size());
        snapshot.points.push_back(snapshot.points[faces[face].nodes[c]]);
      }
    }
  for (const auto& [i, points] : own)
    snapshot.surface[i] = points;
  for (SnapshotField& field : snapshot.point_fields) {
    field.values.assign(snapshot.points.size(), 0.);
    for (const int face : named.at(field.name.substr(3)))
      if (const auto at = place.find(faces[face].nodes); at != place.end())
        for (const int point : own.at(at->second))
          field.values[point] = 1;
  }
}

geom::TetMesh read_vtu_mesh(const std::string& path) {
  const Snapshot snapshot = read_vtu(path);
  geom::TetMesh mesh;
  mesh.nodes = snapshot.points;
  mesh.tets = snapshot.tets;
  mesh.region.assign(mesh.tets.size(), 0);
  if (const SnapshotField* region = find_field(snapshot.cell_fields, "region")) {
    // Ours count from 1; another program's may from 0.
    const double first = std::min(1.0, *std::min_element(region->values.begin(), region->values.end()));
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      mesh.region[t] = static_cast<int>(region->values[t] - first);
  }
  geom::validate(mesh, path);
  return mesh;
}

} // namespace cdem
