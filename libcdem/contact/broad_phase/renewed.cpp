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
      return gone_at_most(model, work, m) > (1 - searched_with_others) * work.skin[m];
    };
    if (!all && m >= blocks && (work.changed[m] || !work.searched_before[m] || soon_due()))
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

} // namespace cdem
