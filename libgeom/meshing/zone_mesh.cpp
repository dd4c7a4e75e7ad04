#include "libgeom/meshing/zone_mesh.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/mesh_size.hpp"
#include "libgeom/mesh/star_mesh.hpp"
#include "libgeom/mesh/tet_mesh.hpp"
#include "libgeom/solid/gmsh_session.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace geom {
namespace {

namespace geo = gmsh::model::geo;

constexpr int triangle_type = 2, tet_type = 4; // gmsh's numbers of linear elements

// The block as gmsh's model: point i + 1 is vertex i, surface f + 1 is face f.
void make_model(const Polyhedron& block, double size) {
  for (std::size_t i = 0; i < block.vertices.size(); ++i) {
    const Vec3& x = block.vertices[i];
    geo::addPoint(x.x(), x.y(), x.z(), size, static_cast<int>(i) + 1);
  }
  std::map<std::array<int, 2>, int> lines; // by ends, ascending: neighbouring faces share them
  std::vector<int> surfaces;
  for (std::size_t f = 0; f < block.faces.size(); ++f) {
    const std::vector<int>& loop = block.faces[f].loop;
    std::vector<int> curves;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const auto [line, added] = lines.try_emplace({std::min(a, b), std::max(a, b)}, 0);
      if (added)
        line->second = geo::addLine(line->first[0] + 1, line->first[1] + 1);
      curves.push_back(a < b ? line->second : -line->second);
    }
    surfaces.push_back(geo::addPlaneSurface({geo::addCurveLoop(curves)}, static_cast<int>(f) + 1));
  }
  geo::addVolume({geo::addSurfaceLoop(surfaces)}, 1);
  geo::synchronize();
}

Triangle ascending(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

// The face of the block that each triangle of gmsh's surfaces lies in, by its nodes in ascending order.
std::map<Triangle, int> faces_of_triangles(std::size_t faces,
                                           const std::unordered_map<std::size_t, int>& node_of) {
  std::map<Triangle, int> face_of;
  for (std::size_t f = 0; f < faces; ++f) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, corners;
    gmsh::model::mesh::getElements(types, elements, corners, 2, static_cast<int>(f) + 1);
    for (std::size_t k = 0; k < types.size(); ++k)
      if (types[k] == triangle_type)
        for (std::size_t c = 0; c + 2 < corners[k].size(); c += 3)
          face_of[ascending({node_of.at(corners[k][c]), node_of.at(corners[k][c + 1]),
                             node_of.at(corners[k][c + 2])})] = static_cast<int>(f);
  }
  return face_of;
}

BlockMesh collect(const Polyhedron& block) {
  BlockMesh mesh;
  mesh.nodes = block.vertices;
  std::unordered_map<std::size_t, int> node_of; // by gmsh's tag
  const auto nodes_on = [](int dim, int tag, std::vector<double>& x) {
    std::vector<std::size_t> tags;
    std::vector<double> ignored;
    gmsh::model::mesh::getNodes(tags, x, ignored, dim, tag, false, false);
    return tags;
  };
  std::vector<double> x;
  for (std::size_t i = 0; i < block.vertices.size(); ++i)
    for (const std::size_t tag : nodes_on(0, static_cast<int>(i) + 1, x))
      node_of[tag] = static_cast<int>(i);
  const std::vector<std::size_t> tags = nodes_on(-1, -1, x);
  for (std::size_t i = 0; i < tags.size(); ++i)
    if (node_of.emplace(tags[i], static_cast<int>(mesh.nodes.size())).second)
      mesh.nodes.emplace_back(Eigen::Map<const Vec3>(&x[3 * i]));

  std::vector<int> types;
  std::vector<std::vector<std::size_t>> elements, corners;
  gmsh::model::mesh::getElements(types, elements, corners, 3, 1);
  TetMesh tets;
  tets.nodes = mesh.nodes;
  for (std::size_t k = 0; k < types.size(); ++k)
    if (types[k] == tet_type)
      for (std::size_t c = 0; c + 3 < corners[k].size(); c += 4)
        tets.tets.push_back({node_of.at(corners[k][c]), node_of.at(corners[k][c + 1]),
                             node_of.at(corners[k][c + 2]), node_of.at(corners[k][c + 3])});
  tets.region.assign(tets.tets.size(), 0);
  validate(tets, "zone_size");
  mesh.tets = tets.tets;

  const std::map<Triangle, int> face_of = faces_of_triangles(block.faces.size(), node_of);
  mesh.fans.resize(block.faces.size());
  mesh.fan_tets.resize(block.faces.size());
  for (const OuterFace& outer : outer_faces(tets)) {
    const auto face = face_of.find(ascending(outer.nodes));
    if (face == face_of.end())
      throw InputError("zone_size: the mesh of the block at " + text(mass_properties(block).centroid) +
                       " m does not end on its faces; give another size");
    mesh.fans[face->second].push_back(outer.nodes);
    mesh.fan_tets[face->second].push_back(outer.tet);
  }
  return mesh;
}

double volume_of(const BlockMesh& mesh) {
  TetMesh tets;
  tets.nodes = mesh.nodes;
  tets.tets = mesh.tets;
  return volume(tets);
}

// The mesh that gmsh holds; the star mesh where that fails to fill the block (a sliver left by a cut) or has fewer tets.
BlockMesh collected_or_star(const Polyhedron& block) {
  constexpr double volume_tolerance = 1e-6;
  BlockMesh star = star_mesh(block);
  try {
    BlockMesh zones = collect(block);
    const double missing = std::abs(volume_of(zones) / mass_properties(block).volume - 1);
    if (zones.tets.size() >= star.tets.size() && missing < volume_tolerance)
      return zones;
  } catch (const InputError&) {
    return star;
  }
  return star;
}

void require_size(const std::vector<Polyhedron>& blocks, double size) {
  if (!(size > 0) || !std::isfinite(size))
    throw InputError("zone_size", text(size), "a finite number > 0 m");
  MeshSize sizes;
  sizes.size = size;
  constexpr double nodes_per_tet = 0.25; // with those on the faces
  double all = 0;
  for (const Polyhedron& block : blocks) {
    const double tets = expected_tets(sizes, bounding_box(block), mass_properties(block).volume);
    if (!(nodes_per_tet * tets <= max_zone_nodes))
      throw InputError("zone_size", text(size), "such that no block has more than 250000 tetrahedra",
                       "the block at " + place_text(mass_properties(block).centroid) + " would have about " +
                           text(std::round(tets)));
    all += tets;
  }
  if (!(all <= max_tets))
    throw InputError("zone_size", text(size), "such that there are at most 20 million tetrahedra",
                     "this asks for about " + text(std::round(all * 1e-6)) + " million");
}

} // namespace

std::vector<BlockMesh> zone_meshes(const std::vector<Polyhedron>& blocks, double size) {
  require_size(blocks, size);
  if (blocks.empty())
    return {};
  return in_session("zone_size", [&] {
    set_mesh_options();
    gmsh::option::setNumber("Mesh.MeshSizeMax", size);
    gmsh::option::setNumber("General.AbortOnError", 0); // surfaces are meshed where nothing can be thrown
    std::vector<BlockMesh> meshes;
    for (const Polyhedron& block : blocks) {
      gmsh::clear();
      make_model(block, size);
      gmsh::model::mesh::generate(3);
      meshes.push_back(collected_or_star(block));
      if (static_cast<int>(meshes.back().nodes.size()) > max_zone_nodes)
        throw InputError("zone_size", text(size), "such that no block has more than 65535 nodes",
                         "the block at " + text(mass_properties(block).centroid) + " m has " +
                             std::to_string(meshes.back().nodes.size()));
    }
    return meshes;
  });
}

} // namespace geom
