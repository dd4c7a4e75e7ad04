#include "libcdem/vtk/outline.hpp"

#include "libcdem/vtk/field_values.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using geom::Vec3;

std::int64_t block_of(const SnapshotField* block_id, std::size_t tet) {
  return block_id ? static_cast<std::int64_t>(block_id->values[tet]) : 0;
}

// For every tet corner a node number that is the same for nodes of one block at one place.
std::vector<geom::Tet> merge_nodes(const Snapshot& s, const SnapshotField* block_id) {
  struct Corner {
    std::int64_t block;
    Vec3 place;
    std::size_t index; // 4 * tet + corner
  };
  std::vector<Corner> corners;
  corners.reserve(4 * s.tets.size());
  for (std::size_t t = 0; t < s.tets.size(); ++t)
    for (std::size_t c = 0; c < 4; ++c)
      corners.push_back({block_of(block_id, t), s.points[static_cast<std::size_t>(s.tets[t][c])], 4 * t + c});
  const auto key_less = [](const Corner& a, const Corner& b) {
    if (a.block != b.block)
      return a.block < b.block;
    for (int i = 0; i < 3; ++i)
      if (a.place[i] != b.place[i])
        return a.place[i] < b.place[i];
    return false;
  };
  std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) {
    return key_less(a, b) || (!key_less(b, a) && a.index < b.index);
  });
  std::vector<geom::Tet> merged(s.tets.size());
  int node = -1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || key_less(corners[i - 1], corners[i]))
      node = s.tets[corners[i].index / 4][corners[i].index % 4]; // the lowest corner names the place
    merged[corners[i].index / 4][corners[i].index % 4] = node;
  }
  return merged;
}

// The faces of a tet, counter-clockwise seen from outside.
constexpr int tet_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

} // namespace

void find_surface(Snapshot& s, double crease) {
  const SnapshotField* block_id = find_field(s.cell_fields, "block_id");
  const std::vector<geom::Tet> merged = merge_nodes(s, block_id);
  s.surface.clear();
  s.surface_tet.clear();
  s.block_edges.clear();

  struct Face {
    std::array<int, 3> key; // merged nodes, ascending
    std::size_t tet;
    int face;
  };
  std::vector<Face> faces;
  faces.reserve(4 * s.tets.size());
  for (std::size_t t = 0; t < s.tets.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      Face face{{}, t, f};
      for (std::size_t c = 0; c < 3; ++c)
        face.key[c] = merged[t][static_cast<std::size_t>(tet_faces[f][c])];
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  std::vector<std::size_t> order(faces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return faces[a].key < faces[b].key; });
  std::vector<char> outside(faces.size(), 0);
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i + 1;
    while (j < order.size() && faces[order[j]].key == faces[order[i]].key)
      ++j;
    if (j == i + 1)
      outside[order[i]] = 1;
    i = j;
  }

  struct Edge {
    std::array<int, 2> key; // merged nodes, ascending
    std::array<int, 2> nodes;
    Vec3 normal;
  };
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!outside[i])
      continue;
    const std::size_t t = faces[i].tet;
    geom::Triangle triangle, key;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto corner = static_cast<std::size_t>(tet_faces[faces[i].face][c]);
      triangle[c] = s.tets[t][corner];
      key[c] = merged[t][corner];
    }
    s.surface.push_back(triangle);
    s.surface_tet.push_back(static_cast<std::int64_t>(t));
    const auto at = [&](std::size_t c) { return s.points[static_cast<std::size_t>(triangle[c])]; };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      edges.push_back(
          {{std::min(key[c], key[d]), std::max(key[c], key[d])}, {triangle[c], triangle[d]}, normal});
    }
  }
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key < b.key; });
  const double flat = crease < 0 ? 2 : std::cos(crease);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    bool corner = false;
    for (; j < edges.size() && edges[j].key == edges[i].key; ++j)
      corner = corner || edges[i].normal.dot(edges[j].normal) < flat;
    if (corner || j == i + 1)
      s.block_edges.push_back(edges[i].nodes);
    i = j;
  }
}

std::vector<Vec3> deformed(const std::vector<Vec3>& points, const SnapshotField* displacement, double scale) {
  std::vector<Vec3> moved = points;
  if (displacement && scale != 0)
    for (std::size_t i = 0; i < moved.size(); ++i)
      moved[i] += scale * Vec3(displacement->values[3 * i], displacement->values[3 * i + 1],
                               displacement->values[3 * i + 2]);
  return moved;
}

namespace {

// The springs of a mesh's face stand in the middle between its corners and its centroid; drawn from corner to corner
// its edges show where the crack comes to the surface.
void reach_corners(const geom::Triangle& springs, std::vector<geom::Vec3>& points) {
  geom::Vec3 centroid = geom::Vec3::Zero();
  for (const int p : springs)
    centroid += points[p] / 3;
  for (const int p : springs)
    points[p] = 2 * points[p] - centroid;
}

} // namespace

BrokenInterfaces broken_interfaces(const BondSnapshot& bonds, double deformation) {
  BrokenInterfaces broken;
  const SnapshotField* mode = find_field(bonds.triangle_fields, "mode");
  if (!mode)
    return broken;
  const SnapshotField* interface_id = find_field(bonds.triangle_fields, "interface_id");
  broken.points = deformed(bonds.points, displacement_of(bonds.point_fields), deformation);

  struct Edge {
    std::int64_t interface;
    std::array<int, 2> nodes; // ascending
    bool shear;
  };
  std::vector<Edge> edges;
  for (std::size_t t = 0; t < bonds.triangles.size(); ++t) {
    const int value = static_cast<int>(mode->values[t]);
    const bool tension = value == static_cast<int>(BondMode::broken_tension);
    const bool shear = value == static_cast<int>(BondMode::broken_shear);
    if (!tension && !shear)
      continue;
    const geom::Triangle& triangle = bonds.triangles[t];
    (shear ? broken.shear : broken.tension).triangles.push_back(triangle);
    if (interface_id && interface_id->values[t] < 0)
      reach_corners(triangle, broken.points);
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = triangle[c], b = triangle[(c + 1) % 3];
      edges.push_back({interface_id ? static_cast<std::int64_t>(interface_id->values[t]) : 0,
                       {std::min(a, b), std::max(a, b)},
                       shear});
    }
  }
  const auto same = [](const Edge& a, const Edge& b) {
    return a.interface == b.interface && a.nodes == b.nodes;
  };
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.interface != b.interface ? a.interface < b.interface : a.nodes < b.nodes;
  });
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool alone =
        (i == 0 || !same(edges[i - 1], edges[i])) && (i + 1 == edges.size() || !same(edges[i], edges[i + 1]));
    if (alone)
      (edges[i].shear ? broken.shear : broken.tension).outline.push_back(edges[i].nodes);
  }
  return broken;
}

} // namespace cdem
