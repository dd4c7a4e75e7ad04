// The surface that is drawn of a model: outer faces, both sides of faces whose bonds have all broken, and sharp edges.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Places batch * lanes + lane of the faces of meshes, among these batches, whose three springs have broken; ascending.
std::vector<std::int64_t> opened_faces(const Model&, const State&, Range batches);

// visit(chunk, place) for these places batch * lanes + lane, ascending.
template <class Visit>
void each_face_of(const MeshData& mesh, const std::vector<std::int64_t>& faces, const Visit& visit) {
  auto chunk = mesh.chunks.begin();
  for (const std::int64_t face : faces) {
    while (chunk->face_batches.end * lanes <= face)
      ++chunk;
    visit(*chunk, face);
  }
}

// Fills the snapshot's surface and its tets, over nodes and tets of the model; and block_edges.
void add_surface(const Model&, const std::vector<std::int64_t>& opened, Snapshot&);
void add_edges(const Model&, Snapshot&);

// Adds the outline of the bodies, with points and displacements of its own: edges between faces that no other block covers,
// not those at which joints come to the surface.
void add_outline(const Model&, const State&, Snapshot&);

} // namespace cdem
