#include "libcdem/contact/pairs/tet_joints.hpp"

#include "libgeom/core/disjoint_sets.hpp"

#include <algorithm>

namespace cdem {
namespace {

bool is_loose(std::uint8_t hand_over) {
  return hand_over != static_cast<std::uint8_t>(HandOver::held);
}
bool is_let_go(std::uint8_t hand_over) {
  return hand_over == static_cast<std::uint8_t>(HandOver::done);
}

int corner_opposite(const geom::Tet& tet, const geom::Triangle& face) {
  for (int k = 0; k < 4; ++k)
    if (std::find(face.begin(), face.end(), tet[k]) == face.end())
      return k;
  return 0;
}

std::vector<std::uint8_t> outer_planes(const Model& model) {
  const int first = model.mesh.first_tet;
  std::vector<std::uint8_t> planes(model.tets.size() - static_cast<std::size_t>(first), 0);
  for (const ContactTriangle& t : model.surface.triangles)
    if (t.face < 0 && t.tet >= first)
      planes[t.tet - first] |= static_cast<std::uint8_t>(1u << corner_opposite(model.tets[t.tet], t.nodes));
  return planes;
}

} // namespace

std::vector<std::uint8_t> open_planes(const Model& model, const State& state) {
  std::vector<std::uint8_t> planes = outer_planes(model);
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!is_loose(state.faces[batch].handed_over[lane]))
      return;
    const FaceTets& tets = model.mesh.face_tets[batch * lanes + lane];
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    for (const auto& [tet, of] : {std::pair(tets.tet_a, nodes.a), std::pair(tets.tet_b, nodes.b)})
      planes[tet - model.mesh.first_tet] |=
          static_cast<std::uint8_t>(1u << corner_opposite(model.tets[tet], of));
  });
  return planes;
}

TetJoints::TetJoints(const Model& model, const State& state, const std::vector<char>& paired)
    : first_(model.mesh.first_tet), tets_(model.mesh.face_tets) {
  const MeshData& mesh = model.mesh;
  const std::size_t tets = model.tets.size() - static_cast<std::size_t>(first_);
  const auto is_paired = [&](int tet) { return paired[model.tet_block[tet]] != 0; };
  node_.resize(4 * tets);
  int nodes = 0;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    node_[i] = mesh.original[model.tets[first_ + static_cast<int>(i / 4)][i % 4] - mesh.first_node];
    nodes = std::max(nodes, node_[i] + 1);
  }
  fan_begin_.assign(static_cast<std::size_t>(nodes) + 1, 0);
  for (std::size_t i = 0; i < node_.size(); ++i)
    if (is_paired(first_ + static_cast<int>(i / 4)))
      ++fan_begin_[node_[i] + 1];
  for (int n = 0; n < nodes; ++n)
    fan_begin_[n + 1] += fan_begin_[n];
  fan_.resize(fan_begin_.back());
  std::vector<int> next(fan_begin_.begin(), fan_begin_.end() - 1);
  for (std::size_t i = 0; i < node_.size(); ++i)
    if (is_paired(first_ + static_cast<int>(i / 4)))
      fan_[next[node_[i]]++] = static_cast<int>(i);
  outside_.assign(nodes, 0);
  split_.assign(nodes, 0);
  for (const BoundaryTriangle& outer : mesh.boundary)
    if (paired[outer.block])
      for (const int node : outer.nodes)
        outside_[mesh.original[node - mesh.first_node]] = 1;
  outer_ = outer_planes(model);
  face_.assign(node_.size(), -1);
  seen_.assign(mesh.face_tets.size(), 0);
  each_face(mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const std::int64_t face = batch * lanes + lane;
    const FaceNodes nodes_of = face_nodes(mesh, chunk, batch, lane);
    face_[4 * (tets_[face].tet_a - first_) + corner_opposite(model.tets[tets_[face].tet_a], nodes_of.a)] =
        face;
    face_[4 * (tets_[face].tet_b - first_) + corner_opposite(model.tets[tets_[face].tet_b], nodes_of.b)] =
        face;
    seen_[face] = state.faces[batch].handed_over[lane];
  });
  joint_.resize(node_.size());
  place_of_.resize(node_.size());
  place_.assign(tets, -1);
  for (int n = 0; n < nodes; ++n)
    join_around(model, n);
}

void TetJoints::join_around(const Model& model, int node) {
  const int begin = fan_begin_[node], count = fan_begin_[node + 1] - begin;
  if (count == 0)
    return;
  geom::DisjointSets sets(static_cast<std::size_t>(count)), places(static_cast<std::size_t>(count));
  std::vector<std::pair<int, int>> copies; // of the node, and a place that has it
  for (int i = 0; i < count; ++i) {
    const int corner = fan_[begin + i], copy = model.tets[first_ + corner / 4][corner % 4];
    place_[corner / 4] = i;
    const auto known =
        std::find_if(copies.begin(), copies.end(), [&](const auto& c) { return c.first == copy; });
    if (known == copies.end()) {
      copies.emplace_back(copy, i);
      continue;
    }
    sets.unite(i, known->second);
    places.unite(i, known->second);
  }
  bool cracked = false;
  for (int i = 0; i < count; ++i) {
    const int corner = fan_[begin + i];
    for (int k = 0; k < 4; ++k) {
      const std::int64_t face = face_[corner - corner % 4 + k];
      if (k == corner % 4 || face < 0)
        continue;
      const int tet = corner / 4 + first_,
                other = tets_[face].tet_a == tet ? tets_[face].tet_b : tets_[face].tet_a;
      if (!is_loose(seen_[face]))
        sets.unite(i, place_[other - first_]);
      if (!is_let_go(seen_[face]))
        places.unite(i, place_[other - first_]);
      cracked = cracked || is_loose(seen_[face]);
    }
  }
  for (int i = 0; i < count; ++i) {
    const int set = sets.find(i);
    joint_[fan_[begin + i]] = begin + set;
    place_of_[fan_[begin + i]] = begin + places.find(i);
    cracked = cracked || set > 0;
  }
  split_[node] = static_cast<char>(cracked);
}

std::vector<int> TetJoints::update(const Model& model, const State& state) {
  std::vector<int> changed; // nodes
  for (std::size_t face = 0; face < seen_.size(); ++face) {
    const std::uint8_t now = state.faces[face / lanes].handed_over[face % lanes];
    if (now == seen_[face] || tets_[face].tet_a < 0)
      continue;
    seen_[face] = now;
    for (int k = 0; k < 4; ++k)
      changed.push_back(this->node(tets_[face].tet_a, k));
    for (int k = 0; k < 4; ++k)
      changed.push_back(this->node(tets_[face].tet_b, k));
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  std::vector<int> around;
  for (const int node : changed) {
    join_around(model, node);
    for (int i = fan_begin_[node]; i < fan_begin_[node + 1]; ++i)
      around.push_back(first_ + fan_[i] / 4);
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

namespace {

bool share(const int* one, const int* other) {
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k)
      if (one[i] == other[k])
        return true;
  return false;
}

} // namespace

bool TetJoints::may_touch(int tet_a, int tet_b) const {
  const int a = 4 * (tet_a - first_), b = 4 * (tet_b - first_);
  if (share(&joint_[a], &joint_[b]))
    return false;
  for (int k = 0; k < 4; ++k)
    if (const std::int64_t face = face_[a + k];
        face >= 0 && !is_let_go(seen_[face]) && (tets_[face].tet_a == tet_b || tets_[face].tet_b == tet_b))
      return false;
  return true;
}

std::uint8_t TetJoints::open_planes(int tet) const {
  unsigned open = outer_[tet - first_];
  for (int k = 0; k < 4; ++k)
    if (const std::int64_t face = face_[4 * (tet - first_) + k]; face >= 0 && is_loose(seen_[face]))
      open |= 1u << k;
  return static_cast<std::uint8_t>(open);
}

bool TetJoints::in_place(int tet_a, int tet_b) const {
  return share(&place_of_[4 * (tet_a - first_)], &place_of_[4 * (tet_b - first_)]);
}

} // namespace cdem
