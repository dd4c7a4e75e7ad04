// Whether the surface of bodies that move far is whole: triangles, edges and the laws of pairs.
#include "libcdem/checkpoint/whole/checks.hpp"

namespace cdem::whole {

void check_surface(const Model& model) {
  const ContactSurface& surface = model.surface;
  const std::size_t triangles = surface.triangles.size(), nodes = model.node_position.size();
  check_pairs("surface.joint", surface.joint, model);
  for (const auto& [body, joint] : surface.within) {
    below("surface.within", body, model.bodies.size());
    below("surface.within", joint, model.joints.size());
  }
  for (const auto& [joint, left] : surface.left_by) {
    below("surface.left_by", joint, model.joints.size());
    below("surface.left_by", left, model.joints.size());
  }
  for (const BlockPairLaw& pair : surface.pairs) {
    all_below("surface.pairs", pair.blocks, model.blocks.size());
    below("surface.pairs", pair.joint, model.joints.size());
  }
  if (surface.empty()) {
    require_length("surface.edges", surface.edges.size(), 0);
    return;
  }
  require_parts("surface.block_begin", surface.block_begin, model.blocks.size(), triangles);
  require_length("surface.usual_height", surface.usual_height.size(), model.blocks.size());
  require_length("surface.original", surface.original.size(), nodes);
  for (const int node : surface.original)
    below("surface.original", node, nodes);
  for (std::size_t t = 0; t < triangles; ++t) {
    const ContactTriangle& triangle = surface.triangles[t];
    all_below("surface.triangles.nodes", triangle.nodes, nodes);
    below("surface.triangles.block", triangle.block, model.blocks.size());
    require(count(t) >= surface.block_begin[triangle.block] &&
                count(t) < surface.block_begin[triangle.block + 1],
            "surface.triangles.block", triangle.block);
    require(triangle.tet >= model.mesh.first_tet && triangle.tet < count(model.tets.size()),
            "surface.triangles.tet", triangle.tet);
    below("surface.triangles.face", triangle.face, model.mesh.faces.size() * lanes, -1);
    below("surface.triangles.mate", triangle.mate, triangles, -1);
    below("surface.triangles.left", triangle.left, model.joints.size(), -1);
  }
  for (const ContactEdge& edge : surface.edges) {
    all_below("surface.edges.nodes", edge.nodes, nodes);
    all_below("surface.edges.triangles", edge.triangles, triangles);
    below("surface.edges.corner", edge.corner, 3);
    require(surface.triangles[edge.triangles[0]].block == surface.triangles[edge.triangles[1]].block,
            "surface.edges.triangles", edge.triangles[1]);
  }
  require(std::is_sorted(surface.edges.begin(), surface.edges.end(),
                         [](const ContactEdge& a, const ContactEdge& b) { return a.id() < b.id(); }),
          "surface.edges", 0);
}

} // namespace cdem::whole
