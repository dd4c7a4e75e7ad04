#include "libcdem/contact/broad_phase/renewed.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"

#include <algorithm>

namespace cdem {
namespace {

// New surface over the size of a fragment: with more of it the whole is searched, which then costs less than what is around.
constexpr double most_new_surface = 1 / 16.;

// Writes Renewed::surfaced. Rows of what has changed that stay are looked at.
void find_changed(const Model& model, ContactWork& work, Renewed& renewed) {
  const std::vector<ContactTriangle>& triangles = model.surface.triangles;
  renewed.surfaced.assign(work.movers.count(), 0);
  const auto changed = [&](int t) { return work.movers.changed[t] != Change::none; };
  std::vector<int> surfaced(work.movers.count(), 0); // triangles
  bool any = false;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    if (changed(t)) {
      any = true;
      renewed.blocks[triangles[t].block] = 1;
      if (work.movers.changed[t] == Change::surface)
        ++surfaced[work.movers.of_triangle[t]];
    }
  for (int m = 0; m < work.movers.count(); ++m)
    if (surfaced[m] > 0) {
      renewed.surfaced[m] = 1;
      if (surfaced[m] > most_new_surface * size_of(work.movers, m))
        renewed.movers[m] = 1;
    }
  if (!any)
    return;
  for (ContactRow& row : work.rows[Contact::spring].all) {
    const ContactCandidate* const first = work.rows[Contact::spring].candidates.data() + row.begin;
    if (row.pair < 0 &&
        (changed(row.source) || std::any_of(first, first + row.count, [&](const ContactCandidate& c) {
           return changed(static_cast<int>(c.target));
         })))
      row.recheck_distance = row.allowed = row.reach = 0;
  }
}

} // namespace

Renewed movers_to_search(const Model& model, ContactWork& work, bool all) {
  Renewed renewed;
  renewed.all = all;
  renewed.movers.assign(work.movers.count(), static_cast<char>(all));
  renewed.blocks.assign(model.blocks.size(), static_cast<char>(all));
  for (auto m = static_cast<int>(model.blocks.size()); !all && m < work.movers.count(); ++m)
    if (work.motion.skin[m] == 0 || // new
        gone_at_most(model, work.motion, m) > (1 - searched_with_others) * work.motion.skin[m])
      renewed.movers[m] = renewed.blocks[work.movers.block[m]] = 1;
  find_changed(model, work, renewed);
  return renewed;
}

void edges_to_search(const Model& model, const Movers& movers, const SurfaceEdges& edges,
                     const std::vector<ContactEdge>& before, bool fragments_due, Renewed& renewed) {
  const ContactSurface& s = model.surface;
  std::vector<char> changed_at(model.node_position.size(), 0); // per original node
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (const int node : s.triangles[t].nodes)
      if (movers.changed[t] != Change::none)
        changed_at[s.original[node]] = 1;
  renewed.edges.assign(edges.all.size(), 0);
  for (std::size_t e = 0; e < edges.all.size(); ++e) {
    const ContactEdge& edge = edges.all[e];
    const auto searched = [&](int t) { return renewed.movers[movers.of_triangle[t]] != 0; };
    const auto changed = [&](int node) {
      return movers.broken[s.triangles[edge.triangles[0]].block] && changed_at[s.original[node]];
    };
    renewed.edges[e] = static_cast<char>(searched(edge.triangles[0]) || searched(edge.triangles[1]) ||
                                         changed(edge.nodes[0]) || changed(edge.nodes[1]));
  }
  if (!fragments_due)
    return;
  const auto same = [](const ContactEdge& a, const ContactEdge& b) {
    return a.id() == b.id() && a.triangles[1] == b.triangles[1];
  };
  renewed.edge_now.assign(before.size(), -1);
  std::vector<char> known(edges.all.size(), 0);
  std::size_t now = 0;
  for (std::size_t e = 0; e < before.size(); ++e) {
    while (now < edges.all.size() && edges.all[now].id() < before[e].id())
      ++now;
    if (now < edges.all.size() && same(edges.all[now], before[e])) {
      renewed.edge_now[e] = static_cast<int>(now);
      known[now] = 1;
    }
  }
  for (std::size_t e = 0; e < known.size(); ++e)
    renewed.edges[e] = static_cast<char>(renewed.edges[e] | !known[e]);
}

} // namespace cdem
