#include "libcdem/contact/broad_phase/search.hpp"

#include "libcdem/bond/release.hpp"

#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/geometry/semi_edges.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/state/solution_error.hpp"
#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <cassert>
#include <fmt/format.h>

namespace cdem {
namespace {

// Rows by source with their targets by fragment (springs) or block (edges) and number.
void make_rows(const Model& model, const ContactWork& work, const SearchMargin& margins,
               const std::vector<std::vector<Near>>& parts, Contact::Kind kind, std::vector<ContactRow>& rows,
               std::vector<ContactCandidate>& candidates) {
  const ContactSurface& s = model.surface;
  const std::size_t sources = kind == Contact::spring ? s.triangles.size() : work.edges.size();
  std::vector<std::uint32_t> begin(sources + 1, 0);
  for (const std::vector<Near>& part : parts)
    for (const Near& near : part)
      ++begin[near.source + 1];
  for (std::size_t i = 1; i <= sources; ++i)
    begin[i] += begin[i - 1];
  const auto block = [&](std::uint32_t target) {
    return s.triangles[kind == Contact::spring ? target : work.edges[target].triangles[0]].block;
  };
  const auto group = [&](std::uint32_t target) {
    return kind == Contact::spring ? work.fragment[target] : block(target);
  };
  if (candidates.capacity() > 2 * static_cast<std::size_t>(begin.back()))
    std::vector<ContactCandidate>().swap(candidates);
  candidates.resize(begin.back());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const std::vector<Near>& part : parts)
    for (const Near& near : part) {
      ContactCandidate& candidate = candidates[next[near.source]++];
      candidate.target = near.target;
      candidate.springs = near.springs;
      candidate.recheck_distance = 0;
    }
  rows.clear();
  for (std::size_t i = 0; i < sources; ++i) {
    std::sort(candidates.begin() + begin[i], candidates.begin() + begin[i + 1],
              [&](const ContactCandidate& a, const ContactCandidate& b) {
                return std::pair(group(a.target), +a.target) < std::pair(group(b.target), +b.target);
              });
    for (std::uint32_t first = begin[i], end = first; first < begin[i + 1]; first = end) {
      while (end < begin[i + 1] && group(candidates[end].target) == group(candidates[first].target))
        ++end;
      const int other = block(candidates[first].target);
      rows.push_back({static_cast<int>(i), other, first, end - first, 0, 0});
      if (kind == Contact::edge) {
        const int own = s.triangles[work.edges[i].triangles[0]].block;
        rows.back().reach = static_cast<float>(margins.known(own, other) + work.skin[own] + work.skin[other]);
      }
    }
  }
}

[[noreturn]] void refuse_meeting(const Model& model, int block_a, int block_b, const geom::Vec3& x) {
  const auto [first, second] = std::minmax(block_a, block_b);
  const std::string &one = model.bodies[model.blocks[first].body].name,
                    &other = model.bodies[model.blocks[second].body].name;
  throw SolutionError(fmt::format("{} and {} meet near ({:.6g}, {:.6g}, {:.6g}) m and no contact between "
                                  "them is given; add {{\"{}\", \"{}\", "
                                  "cdem.coulomb{{ friction_angle = ... }}}} to contacts",
                                  block_name(model, first), block_name(model, second), x.x(), x.y(), x.z(),
                                  one, other));
}

// Two blocks without a law: nothing may come of it unless they meet. Returns how far each may go before they can, m.
double require_apart(const Model& model, const ActiveSurface& active, const Pairs& pairs) {
  const ContactSurface& s = model.surface;
  double may_go = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : pairs)
    for (const auto& [source, target] : {std::pair(b, a), std::pair(a, b)}) {
      const ContactTriangle &from = s.triangles[active.triangles[source]],
                            &to = s.triangles[active.triangles[target]];
      const double near =
          meeting_ratio * std::min(model.blocks[from.block].size, model.blocks[to.block].size);
      const Corners& x = active.facets[target].x;
      for (const geom::Vec3& corner : active.facets[source].x) {
        const double distance =
            (corner - weighted(x, geom::nearest_on_triangle(corner, x[0], x[1], x[2]).weights)).norm();
        if (distance < near)
          refuse_meeting(model, from.block, to.block, corner);
        may_go = std::min(may_go, std::max(0.5 * (distance - near), 0.25 * near));
      }
    }
  return may_go;
}

// Without those of convex blocks that an interface holds together, and without those of one unbroken fragment that have no
// broken bond between them and what is around them.
Pairs free_pairs(const Model& model, const State& state, const ContactWork& work, Pairs pairs) {
  if (model.frames.empty())
    return pairs;
  const Pairs held = held_pairs(model, state);
  const std::vector<char> loose = blocks_with_broken_bonds(model, state);
  const auto fragment = [&](int block) { return work.fragment[model.surface.block_begin[block]]; };
  const auto convex = [&](int block) { return model.blocks[block].convex(); };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const auto& pair) {
                               const auto [a, b] = std::minmax(pair.first, pair.second);
                               if (!convex(a) || !convex(b))
                                 return false;
                               return (fragment(a) == fragment(b) && !loose[a] && !loose[b]) ||
                                      std::binary_search(held.begin(), held.end(), std::pair<int, int>(a, b));
                             }),
              pairs.end());
  return pairs;
}

} // namespace

double depth_limit(const ContactWork& work, const ContactTriangle& a, const ContactTriangle& b) {
  return std::min(depth_of(work, a), depth_of(work, b));
}

void start_contact(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  if (s.empty())
    return;
  assert(s.triangles.size() <= last_contact_triangle / 2); // edges are fewer than three to two triangles
  std::vector<double> heights;
  for (const ContactTriangle& t : s.triangles)
    if (t.face < 0)
      heights.push_back(t.height);
  std::nth_element(heights.begin(), heights.begin() + heights.size() / 2, heights.end());
  work.usual_height = heights[heights.size() / 2];
  work.shallow = s.usual_height;
  for (double& height : work.shallow)
    height *= shallow_ratio;
  for (std::vector<double>* of_blocks : {&work.travelled, &work.last_displacement, &work.pace, &work.skin})
    of_blocks->assign(model.blocks.size(), 0.0);
  for (const auto& [bodies, law] : s.joint)
    work.restitution = work.restitution || model.joints[law].restitution < 1;
  work.force.assign(model.node_position.size(), Node{});
  work.stiffness.assign(model.node_position.size(), 0.0);
}

bool search_contacts(const Model& model, const State& state, ContactWork& work, int threads) {
  const ContactSurface& s = model.surface;
  if (work.fragments_due) {
    find_fragments(model, state, work);
    find_semi_edges(model, state, work);
  }
  choose_skins(model, state, work);
  const SearchMargin margins(model, state, work);
  const ActiveSurface active = active_surface(model, state, work, margins, threads);
  if (!active.finite())
    return false;
  std::vector<char> has_surface;
  for (std::size_t b = 0; b + 1 < active.block_begin.size(); ++b)
    has_surface.push_back(static_cast<char>(active.block_begin[b] < active.block_begin[b + 1]));
  const Pairs blocks = free_pairs(model, state, work, geom::touching_pairs(active.block_boxes, has_surface));
  std::vector<int> alone; // blocks that may touch themselves
  for (int b = 0; b + 1 < static_cast<int>(s.block_begin.size()); ++b)
    if (model.blocks[b].meshed && model.blocks[b].rigid < 0 && contact_joint(model, b, b))
      alone.push_back(b);
  const auto n_pairs = static_cast<std::int64_t>(blocks.size());
  std::vector<std::vector<Near>> springs(blocks.size() + alone.size()), edges(springs.size());
  std::vector<double> may_go(springs.size(), std::numeric_limits<double>::infinity());
  std::vector<std::string> wrong(springs.size()); // nothing may be thrown out of a parallel loop
  for_chunks(static_cast<std::int64_t>(springs.size()), threads, [&](std::int64_t i) {
    if (i >= n_pairs) {
      NearWithin near = near_within(model, work, margins, active, alone[i - n_pairs]);
      edges[i] = near_edges_within(model, state, work, margins, active, near.meeting);
      springs[i] = near_springs(model, work, margins, active, near.looked_at);
      return;
    }
    const auto [a, b] = blocks[i];
    if (!model.blocks[a].meshed || !model.blocks[b].meshed)
      return;
    const SharedPart part = shared_part(active, a, b);
    if (!contact_joint(model, a, b)) {
      try {
        may_go[i] = require_apart(model, active, meeting(model, margins, active, part));
      } catch (const SolutionError& error) {
        wrong[i] = error.what();
      }
      return;
    }
    edges[i] = near_edges(model, state, work, margins, active, part);
    Pairs pairs = looked_at(model, work, active, part);
    springs[i] = near_springs(model, work, margins, active, pairs);
  });
  for (const std::string& message : wrong)
    if (!message.empty())
      throw SolutionError(message);
  make_rows(model, work, margins, springs, Contact::spring, work.rows[Contact::spring],
            work.candidates[Contact::spring]);
  make_rows(model, work, margins, edges, Contact::edge, work.rows[Contact::edge],
            work.candidates[Contact::edge]);
  work.undefined_pair_margin = may_go.empty() ? std::numeric_limits<double>::infinity()
                                              : *std::min_element(may_go.begin(), may_go.end());
  std::fill(work.travelled.begin(), work.travelled.end(), 0.0);
  work.fragments_due = false;
  work.history_complete = true;
  work.steps_since_search = 0;
  ++work.searches;
  return true;
}

} // namespace cdem
