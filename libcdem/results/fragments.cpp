#include "libcdem/results/fragments.hpp"

#include "libgeom/core/disjoint_sets.hpp"

#include <algorithm>

namespace cdem {
namespace {

bool intact(std::uint8_t mode) {
  return mode == static_cast<std::uint8_t>(BondMode::intact);
}

} // namespace

std::vector<int> pieces_of_nodes(const Model& model, const State& state) {
  geom::DisjointSets sets(model.node_position.size());
  for (const geom::Tet& tet : model.tets)
    for (int k = 1; k < 4; ++k)
      sets.unite(tet[0], tet[k]);
  for (std::size_t p = 0; p < model.points.size(); ++p)
    if (intact(state.bond_mode[p]))
      sets.unite(model.points[p].node_a[0], model.points[p].node_b[0]);
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    if (!intact(state.faces[at.batch].mode[at.point][at.lane]))
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, at.batch, at.lane);
    sets.unite(nodes.a[0], nodes.b[0]);
  });
  std::vector<int> pieces(model.node_position.size());
  for (int node = 0; node < static_cast<int>(pieces.size()); ++node)
    pieces[node] = sets.find(node);
  return pieces;
}

std::vector<Fragment> fragments(const Model& model, const State& state,
                                const ResolvedConditions& conditions) {
  const std::vector<int> pieces = pieces_of_nodes(model, state);
  std::vector<int> place(model.node_position.size(), -1);
  std::vector<Fragment> list;
  const auto of = [&](int node) -> Fragment& {
    int& i = place[pieces[node]];
    if (i < 0) {
      i = static_cast<int>(list.size());
      list.emplace_back();
    }
    return list[i];
  };
  for (const geom::Tet& tet : model.tets) {
    const auto& x = model.node_position;
    const double volume =
        (x[tet[1]] - x[tet[0]]).dot((x[tet[2]] - x[tet[0]]).cross(x[tet[3]] - x[tet[0]])) / 6;
    Fragment& fragment = of(tet[0]);
    fragment.volume += volume;
    fragment.centroid += volume / 4 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]);
    ++fragment.tets;
  }
  for (const HeldNode& h : conditions.held)
    of(h.node).held = true;
  for (Fragment& fragment : list)
    fragment.centroid /= fragment.volume;
  std::stable_sort(list.begin(), list.end(),
                   [](const Fragment& a, const Fragment& b) { return a.volume > b.volume; });
  return list;
}

} // namespace cdem
