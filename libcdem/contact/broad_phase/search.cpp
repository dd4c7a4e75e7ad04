#include "libcdem/contact/broad_phase/search.hpp"

#include "libcdem/bond/release.hpp"

#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/broad_phase/contact_fragments.hpp"
#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/broad_phase/rows.hpp"
#include "libcdem/contact/broad_phase/search_shares.hpp"
#include "libcdem/contact/geometry/face_cover.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/geometry/semi_edges.hpp"
#include "libcdem/joint/softening.hpp"
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
Pairs free_pairs(const Model& model, const State& state, const ContactFragments& fragments, Pairs pairs) {
  if (model.frames.empty())
    return pairs;
  const Pairs held = held_pairs(model, state);
  const std::vector<char> loose = blocks_with_broken_bonds(model, state);
  const auto fragment = [&](int block) { return fragments.of_triangle[model.surface.block_begin[block]]; };
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

// Over a tet's height: what faces open elastically, and in a cohesive body what they open by as they soften. Never further than semi-springs stand in from their corners.
double bonds_give(const Model& model, int block) {
  constexpr double elastic = 3e-4;
  const Body& body = model.bodies[model.blocks[block].body];
  double opening = 0; // m
  const auto add = [&](const Joint& joint) {
    if (joint.softening != Softening::none && joint.tensile_strength > 0)
      opening = std::max(opening, joint.fracture_energy_1 /
                                      (joint.tensile_strength * softening_area(joint.softening)));
  };
  if (body.bonding.is_cohesive()) {
    add(body.joint);
    for (const Joint& joint : body.region_laws.joints)
      add(joint);
  }
  const double height = model.surface.usual_height[block];
  return height > 0 ? std::min(elastic + opening / height, drawn_in) : elastic;
}

} // namespace

double depth_limit(const SurfaceSizes& sizes, const ContactTriangle& a, const ContactTriangle& b) {
  return std::min(depth_of(sizes, a), depth_of(sizes, b));
}

void start_contact(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  work.search.told_due.assign(model.blocks.size(), 1);
  if (s.empty())
    return;
  assert(s.triangles.size() <= last_contact_triangle / 2); // edges are fewer than three to two triangles
  std::vector<double> heights;
  for (const ContactTriangle& t : s.triangles)
    if (t.face < 0)
      heights.push_back(t.height);
  std::nth_element(heights.begin(), heights.begin() + heights.size() / 2, heights.end());
  work.sizes.usual_height = heights[heights.size() / 2];
  work.sizes.shallow = s.usual_height;
  for (double& height : work.sizes.shallow)
    height *= shallow_ratio;
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    work.sizes.bonds_give.push_back(bonds_give(model, static_cast<int>(b)));
  for (std::vector<double>* of_blocks :
       {&work.travel.travelled, &work.travel.last_displacement, &work.travel.skin, &work.rigid_pairs.path})
    of_blocks->assign(model.blocks.size(), 0.0);
  for (const auto& [bodies, law] : s.joint)
    work.knows_motions = work.knows_motions || model.joints[law].restitution < 1;
  work.damps = work.knows_motions || std::any_of(model.blocks.begin(), model.blocks.end(),
                                                 [](const Block& block) { return block.rigid < 0; });
  work.faces = flat_faces(model);
  work.sizes.freed.assign(model.blocks.size(), 0);
  for (const MeshChunk& chunk : model.mesh.chunks)
    if (chunk.side_batches.size() > 0)
      work.sizes.freed[chunk.block] = 1;
  work.loads.force.assign(model.node_position.size(), Node{});
  work.loads.stiffness.assign(model.node_position.size(), 0.0);
  work.loads.rigid_sums.resize(model.rigid.size());
  work.loads.on_rigid.assign(model.rigid.size(), {});
}

namespace {

// Blocks whose fragments are not what they were, or all.
Renewed blocks_to_search(const Model& model, const ContactFragments& fragments, bool all) {
  Renewed renewed;
  renewed.all = all;
  renewed.blocks.assign(model.blocks.size(), static_cast<char>(all));
  for (std::size_t t = 0; t < fragments.changed.size(); ++t)
    if (fragments.changed[t])
      renewed.blocks[model.surface.triangles[t].block] = 1;
  return renewed;
}

// Finds the fragments, and what follows from them. Returns by how much the numbers of each block's edges grow.
std::vector<int> tell_fragments_apart(const Model& model, const State& state, ContactWork& work) {
  const ContactSurface& s = model.surface;
  const std::vector<int> before = std::move(work.edges.begin);
  find_contact_fragments(model, state, work.fragments);
  work.edges = find_semi_edges(model, state, work.fragments, std::move(work.edges.of_broken));
  find_pairwise(model, state, work.fragments, work.rigid_pairs);
  std::vector<int> shift;
  for (std::size_t b = 0; !before.empty() && b + 1 < s.block_begin.size(); ++b)
    shift.push_back(work.edges.begin[s.block_begin[b]] - before[s.block_begin[b]]);
  return shift;
}

// What was found of rows when they were last looked at counts no more; of rigid pairs only where contacts may begin at any
// depth.
void let_all_wake(ContactWork& work, bool pairs_too) {
  for (std::size_t kind = 0; kind < work.rows.size(); ++kind) {
    RowsAsleep& asleep = work.rows[kind].asleep;
    for (std::size_t r = 0; r < work.rows[kind].all.size(); ++r) {
      ContactRow& row = work.rows[kind].all[r];
      if (row.pair >= 0 && !pairs_too)
        continue;
      row.recheck_distance = 0;
      if (kind == Contact::spring)
        row.reach = 0;
      if (row.pair < 0)
        asleep.recheck_distance[r] = 0;
      else
        asleep.of_pairs.until[row.place] = 0;
    }
  }
  if (!pairs_too)
    return;
  for (RigidPair& pair : work.rigid_pairs.all) {
    pair.next = {};
    pair.look_at = 0;
  }
}

} // namespace

bool search_contacts(const Model& model, const State& state, ContactWork& work, int threads) {
  Searches& search = work.search;
  const ContactSurface& s = model.surface;
  const bool fragments_due = search.fragments_due, fragments_only = !model.frames.empty();
  std::vector<int> edge_shift;
  if (fragments_due)
    edge_shift = tell_fragments_apart(model, state, work);
  Renewed renewed = blocks_to_search(model, work.fragments,
                                     search.blocks_due || search.all_due || search.count == 0 ||
                                         (fragments_due && fragments_only));
  renewed.edge_shift = std::move(edge_shift);
  const std::vector<double> pace = choose_skins(model, state, work, renewed.all);
  const SearchMargin margins(model, state, work);
  const ActiveSurface active = active_surface(model, state, work.fragments, margins, threads);
  if (!active.finite())
    return false;
  std::vector<char> has_surface;
  for (std::size_t b = 0; b + 1 < active.block_begin.size(); ++b)
    has_surface.push_back(static_cast<char>(active.block_begin[b] < active.block_begin[b + 1]));
  Pairs blocks =
      free_pairs(model, state, work.fragments, geom::touching_pairs(active.block_boxes, has_surface));
  const auto rigid = std::stable_partition(blocks.begin(), blocks.end(), [&](const auto& pair) {
    return !pairwise(work.rigid_pairs, pair.first, pair.second) ||
           !contact_joint(model, pair.first, pair.second);
  });
  const Pairs rigid_near(rigid, blocks.end());
  blocks.erase(std::remove_if(blocks.begin(), rigid,
                              [&](const auto& pair) {
                                return !renewed.blocks[pair.first] && !renewed.blocks[pair.second];
                              }),
               blocks.end());
  PairsSearched pairs =
      pairs_to_search(model, state, work, margins, pace, renewed.all ? &rigid_near : nullptr);
  renewed.pair_now = std::move(pairs.now);
  std::vector<int> alone; // whole blocks that may touch themselves
  // A star cannot: where the tetrahedra around its middle fill all directions once and none is turned over, each ray from
  // there meets its surface once.
  for (int b = 0; b + 1 < static_cast<int>(s.block_begin.size()); ++b)
    if (model.blocks[b].meshed && !model.blocks[b].star() && model.blocks[b].rigid < 0 && renewed.blocks[b] &&
        !work.fragments.broken[b] && contact_joint(model, b, b))
      alone.push_back(b);
  const auto n_pairs = static_cast<std::int64_t>(blocks.size()),
             n_alone = static_cast<std::int64_t>(alone.size());
  std::vector<double> loads;
  for (const auto& [a, b] : blocks)
    loads.push_back(model.blocks[a].meshed && model.blocks[b].meshed ? near_triangles_of(active, a, b) : 0);
  for (const int b : alone)
    loads.push_back(near_triangles_of(active, b, b));
  for (const int p : pairs.searched)
    loads.push_back(near_triangles_of(active, pairs.pairs[p].a, pairs.pairs[p].b));
  const std::vector<std::int64_t> own = own_share(work, loads);
  const std::size_t n_own = own.size();
  FoundNear found;
  found.springs.resize(n_own);
  found.edges.resize(n_own);
  std::vector<double> may_go(n_own, std::numeric_limits<double>::infinity());
  std::vector<std::string> wrong(n_own); // nothing may be thrown out of a parallel loop
  for_chunks(static_cast<std::int64_t>(n_own), threads, [&](std::int64_t place) {
    const std::int64_t i = own[place];
    std::vector<Near>&springs = found.springs[place], &edges = found.edges[place];
    const auto find_between = [&](const SharedPart& part, const Skins& skins) {
      edges = near_edges(model, state, work, margins, active, part, skins);
      Pairs near = looked_at(model, work, active, part, skins);
      springs = near_springs(model, work, margins, active, near, skins);
    };
    if (i >= n_pairs + n_alone) {
      const RigidPair& pair = pairs.pairs[pairs.searched[i - n_pairs - n_alone]];
      const Skins skins(work.travel.skin, pair.skin);
      const auto [a, b] = std::minmax(pair.a, pair.b);
      find_between(shared_part(active, a, b, skins), skins);
      return;
    }
    const Skins skins(work.travel.skin);
    if (i >= n_pairs) {
      NearWithin near = near_within(model, work, margins, active, alone[i - n_pairs]);
      edges = near_edges_within(model, state, work, margins, active, near.meeting);
      springs = near_springs(model, work, margins, active, near.looked_at, skins);
      return;
    }
    const auto [a, b] = blocks[i];
    if (!model.blocks[a].meshed || !model.blocks[b].meshed)
      return;
    const SharedPart part = shared_part(active, a, b, skins);
    if (!contact_joint(model, a, b)) {
      try {
        may_go[place] = require_apart(model, active, meeting(margins, active, part));
      } catch (const SolutionError& error) {
        wrong[place] = error.what();
      }
      return;
    }
    find_between(part, skins);
  });
  for (std::size_t i = 0; i < n_own; ++i) {
    found.may_go = std::min(found.may_go, may_go[i]);
    if (found.wrong.empty())
      found.wrong = wrong[i];
  }
  share_found(model, work, renewed.all && !pairs.kept, found);
  if (!found.wrong.empty())
    throw SolutionError(found.wrong);
  work.rigid_pairs.all = std::move(pairs.pairs);
  make_rows(model, work, margins, found.springs, Contact::spring, renewed);
  make_rows(model, work, margins, found.edges, Contact::edge, renewed);
  search.undefined_pair_margin =
      renewed.all ? found.may_go : std::min(search.undefined_pair_margin, found.may_go);
  for (std::size_t b = 0; b < renewed.blocks.size(); ++b)
    if (renewed.blocks[b])
      work.travel.travelled[b] = 0;
  ++search.count;
  if (search.anew) // whatever is known, all is looked at
    let_all_wake(work, any_bonded_faces(model, state));
  if (renewed.all)
    search.steps_since = 0;
  search.fragments_due = search.blocks_due = search.pairs_due = search.all_due = search.anew = false;
  search.history_complete = true;
  return true;
}

} // namespace cdem
