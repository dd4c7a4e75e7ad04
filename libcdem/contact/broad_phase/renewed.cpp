#include "libcdem/contact/broad_phase/renewed.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"

#include <algorithm>

namespace cdem {
Renewed movers_to_search(const Model& model, const ContactWork& work, bool all) {
  Renewed renewed;
  renewed.all = all;
  renewed.movers.assign(work.movers.count(), static_cast<char>(all));
  renewed.blocks.assign(model.blocks.size(), static_cast<char>(all));
  const auto blocks = static_cast<int>(model.blocks.size());
  for (int m = 0; m < work.movers.count(); ++m) {
    const int block = work.movers.block[m];
    const auto soon_due = [&] {
      return work.left[m] < searched_with_others ||
             gone_at_most(model, work, m) > (1 - searched_with_others) * work.skin[m];
    };
    if (!all && m >= blocks && (work.changed[m] || work.search_of[m] == 0 || soon_due()))
      renewed.movers[m] = renewed.blocks[block] = 1;
  }
  return renewed;
}

void edges_to_search(const ContactWork& work, const std::vector<ContactEdge>& before, bool fragments_due,
                     Renewed& renewed) {
  renewed.edges.assign(work.edges.size(), 0);
  for (std::size_t e = 0; e < work.edges.size(); ++e)
    for (const int t : work.edges[e].triangles)
      renewed.edges[e] = static_cast<char>(renewed.edges[e] | renewed.movers[work.movers.of_triangle[t]]);
  if (!fragments_due)
    return;
  const auto same = [](const ContactEdge& a, const ContactEdge& b) {
    return a.id() == b.id() && a.triangles[1] == b.triangles[1];
  };
  renewed.edge_now.assign(before.size(), -1);
  std::vector<char> known(work.edges.size(), 0);
  std::size_t now = 0;
  for (std::size_t e = 0; e < before.size(); ++e) {
    while (now < work.edges.size() && work.edges[now].id() < before[e].id())
      ++now;
    if (now < work.edges.size() && same(work.edges[now], before[e])) {
      renewed.edge_now[e] = static_cast<int>(now);
      known[now] = 1;
    }
  }
  for (std::size_t e = 0; e < known.size(); ++e)
    renewed.edges[e] = static_cast<char>(renewed.edges[e] | !known[e]);
}

void keep_near_movers(const Model& model, const Pairs& pairs, const std::vector<char>& searched,
                      ContactWork& work) {
  work.near.resize(work.movers.count());
  work.search_of.resize(work.movers.count(), 0);
  work.left.resize(work.movers.count(), 1);
  work.look_at.resize(work.movers.count(), 0);
  work.past_others.resize(work.movers.count(), 0);
  const auto search = static_cast<int>(work.searches);
  for (int m = static_cast<int>(model.blocks.size()); m < work.movers.count(); ++m)
    if (searched[m]) {
      work.near[m].clear();
      work.search_of[m] = search;
      work.left[m] = 1;
      work.past_others[m] = 0;
      work.look_at[m] = 0.5 * work.skin[m];
    }
  std::vector<int> label(work.movers.count(), -1);
  for (int node = 0; node < static_cast<int>(work.movers.of_fragment.size()); ++node)
    if (work.movers.of_fragment[node] >= 0)
      label[work.movers.of_fragment[node]] = node;
  for (const auto& [a, b] : pairs)
    for (const auto& [m, other] : {std::pair(a, b), std::pair(b, a)}) {
      NearMover near;
      near.fragment = label[other];
      near.search = search;
      near.may_go = rounded_down(work.inner_skin[m] + work.inner_skin[other]);
      near.swings = static_cast<float>(work.swing[m] + work.swing[other]);
      for (int axis = 0; axis < 3; ++axis)
        near.drifts[axis] = static_cast<float>(work.drift[other][axis] - work.drift[m][axis]);
      work.near[m].push_back(near);
      work.look_at[m] = std::min(work.look_at[m], work.travelled[m] + 0.5 * near.may_go);
    }
}

} // namespace cdem
