// What a node has by its block: cheaper to look up where it is asked for than to keep for every node.
#include "libcdem/model/model.hpp"

#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace cdem {

bool is_rigid(const Model& model, const MeshChunk& chunk) {
  for (std::int64_t b = chunk.blocks.begin; b < chunk.blocks.end; ++b)
    if (model.blocks[b].rigid < 0)
      return false;
  return true;
}

Joint joint_of(const Model& model, const Interface& interface) {
  Joint joint = model.joints[interface.joint];
  joint.tensile_strength *= interface.strength;
  joint.cohesion *= interface.strength;
  return joint;
}

std::vector<int> mesh_neighbours(const Model& model) {
  std::vector<geom::Tet> tets(model.tets.begin() + model.mesh.first_tet, model.tets.end());
  std::size_t nodes = 0;
  for (geom::Tet& tet : tets)
    for (int& node : tet) {
      node = model.mesh.original[node - model.mesh.first_node];
      nodes = std::max(nodes, static_cast<std::size_t>(node) + 1);
    }
  return geom::face_neighbours(tets, nodes);
}

int block_of(const Model& model, int node) {
  const auto after = std::upper_bound(model.blocks.begin(), model.blocks.end(), node,
                                      [](int n, const Block& block) { return n < block.node_begin; });
  return static_cast<int>(after - model.blocks.begin()) - 1;
}

double node_volume(const Model& model, int node) {
  return model.gravitational_mass[node] /
         model.bodies[model.blocks[block_of(model, node)].body].material.density;
}

} // namespace cdem
