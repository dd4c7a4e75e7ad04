#include "libcdem/bond/fragments.hpp"

#include "libgeom/core/disjoint_sets.hpp"

#include <algorithm>

namespace cdem {

bool is_untouched(const State& state, std::int64_t batch, int lane) {
  const auto& modes = state.faces[batch].mode;
  return is_intact(modes[0][lane]) && is_intact(modes[1][lane]) && is_intact(modes[2][lane]);
}

bool is_bonded(const State& state, std::int64_t batch, int lane) {
  const auto& modes = state.faces[batch].mode;
  return is_intact(modes[0][lane]) || is_intact(modes[1][lane]) || is_intact(modes[2][lane]);
}

namespace {

ToldOfBonds bonds_of(const State& state, const Interface& interface) {
  const auto begin = state.bond_mode.begin() + interface.point_begin,
             end = state.bond_mode.begin() + interface.point_end;
  const auto whole = std::count_if(begin, end, is_intact);
  return whole == end - begin ? ToldOfBonds::whole
         : whole > 0          ? ToldOfBonds::some_broken
                              : ToldOfBonds::all_broken;
}

} // namespace

bool all_bonds_are_told(const Model& model, const State& state) {
  return std::all_of(model.interfaces.begin(), model.interfaces.end(), [&](const Interface& interface) {
    return interface.frame < 0 || told_of(state, interface.frame) == bonds_of(state, interface);
  });
}

void tell_of_bonds(const Model& model, State& state, const std::vector<char>& blocks) {
  for (const Interface& interface : model.interfaces)
    if (interface.frame >= 0 && blocks[interface.block_a] != 0)
      state.told_bonds[interface.frame] = static_cast<std::uint8_t>(bonds_of(state, interface));
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (blocks[chunk.block] == 0)
      return;
    FaceStateBatch& face = state.faces[batch];
    const bool gone = handed_over(face, lane);
    face.told[lane] = static_cast<std::uint8_t>((is_untouched(state, batch, lane) ? 0 : ToldOfFace::broken) |
                                                (is_bonded(state, batch, lane) ? 0 : ToldOfFace::separate) |
                                                (gone || leaves(face, lane) ? ToldOfFace::left : 0) |
                                                (gone ? ToldOfFace::gone : 0));
  });
}

std::vector<int> fragments_of_nodes(const Model& model, const State& state, Joins by) {
  geom::DisjointSets sets(model.node_position.size());
  for (const geom::Tet& tet : model.tets)
    for (int k = 1; k < 4; ++k)
      sets.unite(tet[0], tet[k]);
  for (const RigidBody& body : model.rigid) { // broken faces part nothing within it
    const Block& block = model.blocks[body.block];
    for (int node = block.node_begin; node < block.node_end; ++node)
      sets.unite(block.node_begin, node);
  }
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const int frame = model.interfaces[model.points[p].interface].frame;
    if (by == Joins::told && frame >= 0 ? told_of(state, frame) != ToldOfBonds::all_broken
                                        : is_intact(state.bond_mode[p]))
      sets.unite(model.points[p].node_a[0], model.points[p].node_b[0]);
  }
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    if (at.point != 0)
      return; // once a face
    const bool joins = by == Joins::told ? (state.faces[at.batch].told[at.lane] & ToldOfFace::broken) == 0
                                         : is_bonded(state, at.batch, at.lane);
    if (!joins)
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, at.batch, at.lane);
    sets.unite(nodes.a[0], nodes.b[0]);
  });
  std::vector<int> pieces(model.node_position.size());
  for (int node = 0; node < static_cast<int>(pieces.size()); ++node)
    pieces[node] = sets.find(node);
  return pieces;
}

} // namespace cdem
