#include "libgeom/meshing/joined_mesh.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/mesh/mesh_size.hpp"
#include "libgeom/solid/gmsh_session.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

namespace geo = gmsh::model::geo;

// The blocks as gmsh's model: point i + 1 is point i, surface i + 1 is part i, volume i + 1 is block i.
void make_joined_model(std::size_t blocks, const DividedFaces& all, double size) {
  std::map<std::pair<int, int>, int> lines;
  std::vector<char> added_point(all.points.size(), 0);
  const auto point = [&](int i) {
    const Vec3& x = all.points[i];
    if (!std::exchange(added_point[i], 1))
      geo::addPoint(x.x(), x.y(), x.z(), size, i + 1);
    return i + 1;
  };
  std::vector<std::vector<int>> surfaces(blocks);
  for (std::size_t f = 0; f < all.parts.size(); ++f) {
    const FacePart& part = all.parts[f];
    std::vector<int> curves;
    for (std::size_t i = 0; i < part.loop.size(); ++i) {
      const int a = part.loop[i], b = part.loop[(i + 1) % part.loop.size()];
      const auto [line, added] = lines.try_emplace(std::minmax(a, b), 0);
      if (added)
        line->second = geo::addLine(point(line->first.first), point(line->first.second));
      curves.push_back(a < b ? line->second : -line->second);
    }
    const int surface = geo::addPlaneSurface({geo::addCurveLoop(curves)}, static_cast<int>(f) + 1);
    surfaces[part.block_a].push_back(surface);
    if (part.block_b >= 0)
      surfaces[part.block_b].push_back(-surface);
  }
  for (std::size_t b = 0; b < blocks; ++b)
    geo::addVolume({geo::addSurfaceLoop(surfaces[b])}, static_cast<int>(b) + 1);
  geo::synchronize();
}

} // namespace

TetMesh joined_mesh(const std::vector<Polyhedron>& blocks, const DividedFaces& all) {
  TetMesh mesh;
  std::vector<int> node_of(all.points.size(), -1);
  const auto node = [&](int point) {
    if (node_of[point] < 0) {
      node_of[point] = static_cast<int>(mesh.nodes.size());
      mesh.nodes.push_back(all.points[point]);
    }
    return node_of[point];
  };
  const auto add = [&](const Vec3& x) {
    mesh.nodes.push_back(x);
    return static_cast<int>(mesh.nodes.size()) - 1;
  };
  std::vector<int> centre_of(blocks.size(), -1);
  const auto centre_of_block = [&](int block) {
    if (centre_of[block] < 0)
      centre_of[block] = add(mass_properties(blocks[block]).centroid);
    return centre_of[block];
  };
  for (const FacePart& part : all.parts) {
    const int centre = add(centroid(all, part));
    for (std::size_t i = 0; i < part.loop.size(); ++i) {
      const int start = node(part.loop[i]), end = node(part.loop[(i + 1) % part.loop.size()]);
      mesh.tets.push_back({centre_of_block(part.block_a), centre, start, end});
      mesh.region.push_back(part.block_a);
      if (part.block_b >= 0) {
        mesh.tets.push_back({centre_of_block(part.block_b), centre, end, start});
        mesh.region.push_back(part.block_b);
      }
    }
  }
  validate(mesh, "shape");
  return mesh;
}

TetMesh joined_mesh(const std::vector<Polyhedron>& blocks, const DividedFaces& all, double zone_size) {
  MeshSize sizes;
  sizes.size = zone_size;
  double expected = 0;
  for (const Polyhedron& block : blocks)
    expected += expected_tets(sizes, bounding_box(block), mass_properties(block).volume);
  if (!(expected <= max_tets))
    throw InputError("zone_size", text(zone_size), "such that there are at most 20 million tetrahedra",
                     "this asks for about " + text(std::round(expected * 1e-6)) + " million");
  TetMesh mesh = in_session("zone_size", [&] {
    set_mesh_options();
    gmsh::option::setNumber("Mesh.MeshSizeMax", zone_size);
    gmsh::option::setNumber("General.AbortOnError", 0); // surfaces are meshed where nothing can be thrown
    make_joined_model(blocks.size(), all, zone_size);
    gmsh::model::mesh::generate(3);
    return tets_of_volumes("zone_size");
  });
  validate(mesh, "zone_size");
  return mesh;
}

} // namespace geom
