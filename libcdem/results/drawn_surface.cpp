#include "libcdem/results/drawn_surface.hpp"

#include "libcdem/joint/bond_mode.hpp"

#include <algorithm>
#include <map>

namespace cdem {
namespace {

// Edges at which the surface of a mesh turns by more than this are drawn: cos of 30 degrees.
constexpr double flat = 0.866;

bool opened(const FaceStateBatch& state, int lane) {
  return std::none_of(std::begin(state.mode), std::end(state.mode),
                      [&](const auto& point) { return is_intact(point[lane]); });
}

void add_edges_of_meshes(const Model& model, Snapshot& snapshot) {
  struct Side {
    geom::Vec3 normal;
    int face; // of a zoned block
  };
  std::map<std::array<int, 2>, Side> first_at; // the first triangle that has the edge
  for (const BoundaryTriangle& triangle : model.mesh.boundary) {
    if (model.blocks[triangle.block].star())
      continue;
    const auto& x = model.node_position;
    const geom::Vec3 normal = (x[triangle.nodes[1]] - x[triangle.nodes[0]])
                                  .cross(x[triangle.nodes[2]] - x[triangle.nodes[0]])
                                  .normalized();
    for (int i = 0; i < 3; ++i) {
      const std::array<int, 2> ends{triangle.nodes[i], triangle.nodes[(i + 1) % 3]};
      const int a = model.mesh.original[ends[0] - model.mesh.first_node],
                b = model.mesh.original[ends[1] - model.mesh.first_node];
      const auto [found, first] =
          first_at.emplace(std::array<int, 2>{std::min(a, b), std::max(a, b)}, Side{normal, triangle.face});
      if (!first && (found->second.normal.dot(normal) < flat || found->second.face != triangle.face))
        snapshot.block_edges.push_back(ends);
    }
  }
}

} // namespace

std::vector<std::int64_t> opened_faces(const Model& model, const State& state, Range batches) {
  std::vector<std::int64_t> places;
  for (const MeshChunk& chunk : model.mesh.chunks) {
    if (chunk.face_batches.begin < batches.begin || chunk.face_batches.begin >= batches.end)
      continue;
    for (int face = 0; face < chunk.faces; ++face)
      if (opened(state.faces[chunk.face_batches.begin + face / lanes], face % lanes))
        places.push_back(chunk.face_batches.begin * lanes + face);
  }
  return places;
}

void add_surface(const Model& model, const std::vector<std::int64_t>& opened, Snapshot& snapshot) {
  const auto add = [&](const geom::Triangle& nodes, int tet) {
    snapshot.surface.push_back(nodes);
    snapshot.surface_tet.push_back(tet);
  };
  for (const Block& block : model.blocks) {
    if (!block.star())
      continue;
    // The star mesh makes one tet for each triangle of the faces' fans, corner 0 at the centroid, in the same order.
    for (int t = block.tet_begin; t < block.tet_end; ++t)
      add({model.tets[t][1], model.tets[t][2], model.tets[t][3]}, t);
  }
  for (const BoundaryTriangle& triangle : model.mesh.boundary)
    if (!model.blocks[triangle.block].star())
      add(triangle.nodes, triangle.tet);
  each_face_of(model.mesh, opened, [&](const MeshChunk& chunk, std::int64_t face) {
    const FaceNodes nodes = face_nodes(model.mesh, chunk, face / lanes, static_cast<int>(face % lanes));
    add(nodes.a, model.mesh.face_tets[face].tet_a);
    add(nodes.outward_b(), model.mesh.face_tets[face].tet_b);
  });
}

void add_edges(const Model& model, Snapshot& snapshot) {
  for (const Block& block : model.blocks)
    if (block.star())
      for (const auto& edge : geom::edges(block.shape))
        snapshot.block_edges.push_back({block.node_begin + edge[0], block.node_begin + edge[1]});
  add_edges_of_meshes(model, snapshot);
}

} // namespace cdem
