#include "libcdem/contact/broad_phase/tet_pairs.hpp"

#include "libcdem/contact/broad_phase/tets_beyond.hpp"
#include "libcdem/contact/data/tet_contacts.hpp"
#include "libcdem/contact/response/tet_potential.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/disjoint_sets.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Skin of a tetrahedron, over the usual height of one at the surface of its block.
constexpr double skin_ratio = 0.05;

// Per node of the model: the smallest copy of it that its tetrahedra hang together with there.
std::vector<int> joints_of(const Model& model, const State& state, const ContactWork& work) {
  geom::DisjointSets sets(model.node_position.size());
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!work.broken[chunk.block] || (state.faces[batch].told[lane] & ToldOfFace::separate) != 0)
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    for (int k = 0; k < 3; ++k)
      sets.unite(nodes.a[k], nodes.b[k]);
  });
  std::vector<int> joint(model.node_position.size());
  for (int node = 0; node < static_cast<int>(joint.size()); ++node)
    joint[node] = sets.find(node);
  return joint;
}

// Pairs of tetrahedra whose common face has broken and is still held by its own springs.
std::vector<std::pair<int, int>> held_by_faces(const Model& model, const State& state, const ContactWork& work) {
  std::vector<std::pair<int, int>> held;
  for (const ContactTriangle& t : model.surface.triangles)
    if (t.face >= 0 && work.broken[t.block] && t.tet < model.surface.triangles[t.mate].tet &&
        (state.faces[t.face / lanes].told[t.face % lanes] & ToldOfFace::left) == 0)
      held.emplace_back(t.tet, model.surface.triangles[t.mate].tet);
  std::sort(held.begin(), held.end());
  return held;
}

void find_tets(const Model& model, const ContactWork& work, TetContacts& found) {
  found.nodes_begin.push_back(0);
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block) {
    if (!touches_itself(model, work, block))
      continue;
    const std::vector<char> at_surface = tets_at_surface(model, work, block);
    const std::size_t first = found.nodes.size();
    for (std::size_t i = 0; i < at_surface.size(); ++i)
      if (at_surface[i]) {
        const int tet = model.blocks[block].tet_begin + static_cast<int>(i);
        found.tets.push_back({tet, block, tet_size(model, tet)});
        const geom::Tet& nodes = model.tets[found.tets.back().tet];
        found.nodes.insert(found.nodes.end(), nodes.begin(), nodes.end());
      }
    const auto begin = found.nodes.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, found.nodes.end());
    found.nodes.erase(std::unique(begin, found.nodes.end()), found.nodes.end());
    found.block_of_nodes.push_back(block);
    found.nodes_begin.push_back(static_cast<int>(found.nodes.size()));
  }
}

void set_places(const Model& model, const State& state, TetContacts& of) {
  for (const int node : of.nodes) {
    const geom::Vec3 x = place_of(model, state, node);
    of.place[node] = {x.x(), x.y(), x.z(), 0};
  }
}

// Leaves pairs that a plane of one of them parts by less than their skins.
void add_near(const Model& model, const State& state, const std::vector<std::pair<int, int>>& pairs,
              TetContacts& to) {
  auto contact = std::partition_point(state.contacts.begin(), state.contacts.end(),
                                      [](const Contact& c) { return c.kind != Contact::tets; });
  std::vector<TetPairBatch> batches((pairs.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < lanes * batches.size(); ++i) {
    const auto& [a, b] = pairs[std::min(i, pairs.size() - 1)];
    for (int k = 0; k < 4; ++k) {
      batches[i / lanes].node[k][i % lanes] = model.tets[to.tets[a].tet][k];
      batches[i / lanes].node[4 + k][i % lanes] = model.tets[to.tets[b].tet][k];
    }
  }
  find_parted(to.place.data(), batches.data(), static_cast<std::int64_t>(batches.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    double apart = -batches[i / lanes].deepest[i % lanes];
    const std::pair<int, int> tets(to.tets[pairs[i].first].tet, to.tets[pairs[i].second].tet);
    while (contact != state.contacts.end() && std::pair<int, int>(contact->source, contact->target) < tets)
      ++contact;
    if (contact != state.contacts.end() && std::pair<int, int>(contact->source, contact->target) == tets)
      apart = 0;
    if (apart > 2 * to.skin)
      continue;
    to.a.push_back(pairs[i].first);
    to.b.push_back(pairs[i].second);
    to.until.push_back(rounded_down(apart));
  }
}

} // namespace

bool touches_itself(const Model& model, const ContactWork& work, int block) {
  const Block& b = model.blocks[block];
  return work.broken[block] && b.meshed && !b.star() && b.rigid < 0 && contact_joint(model, block, block);
}

void find_tet_pairs(const Model& model, const State& state, ContactWork& work) {
  bool any = false;
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block)
    any = any || touches_itself(model, work, block);
  if (!any) {
    work.tet_contacts = nullptr;
    return;
  }
  auto found = std::make_shared<TetContacts>();
  if (work.tet_contacts)
    std::swap(found->place, work.tet_contacts->place);
  work.tet_contacts = found;
  TetContacts& to = *found;
  to.place.resize(model.node_position.size());
  to.way.resize(model.node_position.size());
  find_tets(model, work, to);
  set_places(model, state, to);
  to.path.assign(to.tets.size(), 0.0);
  to.skin = std::numeric_limits<double>::infinity();
  for (const int block : to.block_of_nodes)
    to.skin = std::min(to.skin, skin_ratio * model.surface.usual_height[block]);
  std::vector<geom::Box> boxes(to.tets.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const int node : model.tets[to.tets[i].tet])
      boxes[i].extend(geom::Vec3(to.place[node].x, to.place[node].y, to.place[node].z));
    boxes[i].min.array() -= to.skin;
    boxes[i].max.array() += to.skin;
  }
  const std::vector<int> joint = joints_of(model, state, work);
  const std::vector<std::pair<int, int>> held = held_by_faces(model, state, work);
  std::vector<std::pair<int, int>> pairs = geom::touching_pairs(boxes);
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const std::pair<int, int>& pair) {
                               const SurfaceTet &a = to.tets[pair.first], &b = to.tets[pair.second];
                               if (a.block != b.block)
                                 return true;
                               for (const int m : model.tets[a.tet])
                                 for (const int n : model.tets[b.tet])
                                   if (joint[m] == joint[n])
                                     return true;
                               return std::binary_search(held.begin(), held.end(), std::pair(a.tet, b.tet));
                             }),
              pairs.end());
  if (!pairs.empty())
    add_near(model, state, pairs, to);
  to.awake.assign((to.a.size() + contact_rows_per_chunk - 1) / contact_rows_per_chunk, 0);
}

bool pairs_left_skin(const ContactWork& work) {
  const TetContacts& of = *work.tet_contacts;
  return std::any_of(of.path.begin(), of.path.end(), [&](double path) { return path > of.skin; });
}

void move_tets(const Model& model, const State& state, ContactWork& work) {
  TetContacts& of = *work.tet_contacts;
  set_places(model, state, of);
  for (std::size_t i = 0; i < of.block_of_nodes.size(); ++i) {
    const auto begin = of.nodes.begin() + of.nodes_begin[i], end = of.nodes.begin() + of.nodes_begin[i + 1];
    geom::Vec3 mean = geom::Vec3::Zero(); // m/s
    for (auto node = begin; node != end; ++node)
      mean += velocity_of(state, *node);
    mean /= std::max<double>(1, static_cast<double>(end - begin));
    for (auto node = begin; node != end; ++node)
      of.way[*node] = work.step * (velocity_of(state, *node) - mean).norm();
  }
  constexpr double rounding = 1 + 1e-6;
  for (std::size_t i = 0; i < of.tets.size(); ++i) {
    const geom::Tet& n = model.tets[of.tets[i].tet];
    of.path[i] += rounding * std::max(std::max(of.way[n[0]], of.way[n[1]]), std::max(of.way[n[2]], of.way[n[3]]));
  }
}

} // namespace cdem
