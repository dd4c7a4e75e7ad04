#include "libcdem/results/fragments.hpp"

#include "libcdem/bond/fragments.hpp"

#include <algorithm>

namespace cdem {

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
