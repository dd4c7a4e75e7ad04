// Laws every assembly that fills a region must keep.
#pragma once

#include "libgeom/assembly/assembly.hpp"
#include "libgeom/mesh/star_mesh.hpp"
#include "libgeom/query/face_overlap.hpp"

#include <cmath>

namespace testing {

inline double total_volume(const geom::Assembly& assembly) {
  double sum = 0;
  for (const geom::Polyhedron& block : assembly.blocks)
    sum += geom::mass_properties(block).volume;
  return sum;
}

// Area of all block faces that is neither shared with another block (counted on both sides) nor on the given
// outside surface: zero when the blocks fill their region without gaps.
inline double loose_area(const geom::Assembly& assembly, double outside, double tolerance) {
  double faces = 0, shared = 0;
  std::vector<geom::BlockMesh> meshes;
  for (const geom::Polyhedron& block : assembly.blocks) {
    for (std::size_t f = 0; f < block.faces.size(); ++f)
      faces += geom::face_area(block, static_cast<int>(f));
    meshes.push_back(geom::star_mesh(block));
  }
  for (const geom::SharedFace& s : geom::shared_faces(assembly.blocks, tolerance)) {
    const geom::BlockMesh &a = meshes[s.block_a], &b = meshes[s.block_b];
    shared += geom::overlap(a.nodes, a.fans[s.face_a], b.nodes, b.fans[s.face_b],
                            geom::face_normal(assembly.blocks[s.block_a], s.face_a), tolerance)
                  .area;
  }
  return std::abs(faces - outside - 2 * shared);
}

inline double box_surface(const geom::Vec3& size) {
  return 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
}

} // namespace testing
