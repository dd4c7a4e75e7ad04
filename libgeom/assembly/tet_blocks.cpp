#include "libgeom/assembly/tet_blocks.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/mesh/boundary.hpp"

namespace geom {

Assembly tet_blocks(const TetMesh& mesh) {
  require_block_count("mesh", std::to_string(mesh.tets.size()) + " tetrahedra",
                      static_cast<double>(mesh.tets.size()), "each becomes a block; mesh coarser");
  Assembly assembly;
  assembly.blocks.reserve(mesh.tets.size());
  for (const Tet& tet : mesh.tets) {
    Polyhedron block;
    for (const int node : tet)
      block.vertices.push_back(mesh.nodes[node]);
    for (const auto& face : tet_faces)
      block.faces.push_back({{face[0], face[1], face[2]}});
    assembly.blocks.push_back(std::move(block));
  }
  return assembly;
}

} // namespace geom
