#include "libcdem/results/fragments.hpp"

#include "libcdem/bond/fragments.hpp"

#include <algorithm>

namespace cdem {

namespace {

double tet_volume(const Model& model, const geom::Tet& tet) {
  const auto& x = model.node_position;
  return (x[tet[1]] - x[tet[0]]).dot((x[tet[2]] - x[tet[0]]).cross(x[tet[3]] - x[tet[0]])) / 6;
}

} // namespace

std::vector<int> fragment_ranks(const Model& model, const State& state) {
  const std::vector<int> pieces = fragments_of_nodes(model, state); // by the first node of each
  std::vector<double> volume(pieces.size(), 0);
  std::vector<char> parted(pieces.size(), 0); // from the rest of a body
  std::vector<int> piece_of_body(model.bodies.size(), -1);
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const int piece = pieces[model.tets[t][0]];
    volume[piece] += tet_volume(model, model.tets[t]);
    int& first = piece_of_body[model.blocks[model.tet_block[t]].body];
    if (first < 0)
      first = piece;
    if (piece != first)
      parted[piece] = parted[first] = 1;
  }
  std::vector<int> ranked;
  for (int piece = 0; piece < static_cast<int>(pieces.size()); ++piece)
    if (parted[piece])
      ranked.push_back(piece);
  std::stable_sort(ranked.begin(), ranked.end(), [&](int a, int b) { return volume[a] > volume[b]; });
  std::vector<int> rank(pieces.size(), 0), of_node;
  for (std::size_t i = 0; i < ranked.size(); ++i)
    rank[ranked[i]] = static_cast<int>(i) + 1;
  for (const int piece : pieces)
    of_node.push_back(rank[piece]);
  return of_node;
}

std::vector<Fragment> fragments(const Model& model, const State& state,
                                const ResolvedConditions& conditions) {
  const std::vector<int> pieces = fragments_of_nodes(model, state);
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
    const double volume = tet_volume(model, tet);
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
