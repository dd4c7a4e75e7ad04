#include "libcdem/fracture/notch.hpp"

#include "libcdem/bond/freed_face.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/model/build/add_meshes.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace cdem {
namespace {

using Selects = std::function<bool(const geom::Vec3&, int)>;

// All three points of the face of a tet.
bool is_selected(const Model& model, int tet, int face, const Selects& at) {
  geom::Vec3 corners[3];
  for (int k = 0; k < 3; ++k)
    corners[k] = model.node_position[model.tets[tet][geom::tet_faces[face][k]]];
  for (int point = 0; point < 3; ++point) {
    geom::Vec3 place = geom::Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      place += point_weight(point, k) * corners[k];
    if (!at(place, model.tet_block[tet]))
      return false;
  }
  return true;
}

// Of the faces of cohesive bodies that are selected, by node of the model; none where all of them are free.
std::vector<char> nodes_to_free(const Model& model, const Selects& at) {
  std::vector<char> nodes(model.node_position.size(), 0);
  const MeshData& mesh = model.mesh;
  const std::vector<int> neighbours = mesh_neighbours(model);
  for (int t = mesh.first_tet; t < static_cast<int>(model.tets.size()); ++t) {
    const Bonding& bonding = model.bodies[model.blocks[model.tet_block[t]].body].bonding;
    if (!bonding.is_cohesive())
      continue;
    for (int face = 0; face < 4; ++face) {
      const int beyond = neighbours[4 * (t - mesh.first_tet) + face];
      if (beyond < 0 || !bonding.bonds(mesh.region[t - mesh.first_tet], mesh.region[beyond / 4]) ||
          !is_selected(model, t, face, at))
        continue;
      for (const int corner : geom::tet_faces[face]) {
        const int node = model.tets[t][corner];
        if (mesh.freed[node - mesh.first_node] == 0)
          nodes[node] = 1;
      }
    }
  }
  return nodes;
}

} // namespace

std::int64_t notch(Model& model, State& state, const Selects& at) {
  const std::vector<char> nodes = nodes_to_free(model, at);
  if (std::find(nodes.begin(), nodes.end(), 1) != nodes.end()) {
    Freed freed = split_nodes(model, state, nodes);
    model = std::move(freed.model);
    state = std::move(freed.state);
  }
  std::int64_t count = 0;
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const FaceStateBatch& face = state.faces[batch];
    if (!model.bodies[model.blocks[chunk.block].body].bonding.is_cohesive() ||
        face.stage[lane] == FaceStage::parted || face.stage[lane] == FaceStage::separated)
      return;
    for (int point = 0; point < 3; ++point)
      if (!at(face_point(model, chunk, {batch, point, lane}), chunk.block))
        return;
    const FaceTets& tets = model.mesh.face_tets[batch * lanes + lane];
    geom::Mat3 stress = geom::Mat3::Zero(); // on a face that cracks the stress of its tets does not act
    if (holds(face.stage[lane]))
      stress = 0.5 * (matrix(mesh_stress(model, state, tets.tet_a)) +
                      matrix(mesh_stress(model, state, tets.tet_b)));
    break_face(model, state, chunk, batch, lane, stress);
    count += 3;
  });
  return count;
}

} // namespace cdem
