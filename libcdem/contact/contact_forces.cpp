#include "libcdem/contact/contact_forces.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/broad_phase/block_travel.hpp"
#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/found_contacts.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/narrow_phase/evaluation.hpp"
#include "libcdem/contact/narrow_phase/press_tets.hpp"
#include "libcdem/contact/narrow_phase/row_shares.hpp"
#include "libcdem/contact/narrow_phase/rows_asleep.hpp"
#include "libcdem/contact/response/block_motion.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Chunks of rows a thread computes before what they found is added up: more than a few leave the cache.
constexpr std::int64_t chunks_at_a_time = 16;

// The furthest that a node of each block goes in a step of this length. True when one has left its skin.
bool add_displacements(const Model& model, const State& state, ContactWork& work, int threads) {
  if (work.search.count == 0)
    return true;
  BlockTravel& travel = work.travel;
  travel.last_displacement = speeds_of_blocks(model, state, work, threads);
  for (std::size_t b = 0; b < travel.travelled.size(); ++b) {
    const double way = travel.last_displacement[b] *= work.step;
    travel.travelled[b] += way;
    if (way > 0) // rounded up
      work.rigid_pairs.path[b] =
          (work.rigid_pairs.path[b] + way) * (1 + std::numeric_limits<double>::epsilon());
  }
  set_poses(model, state, work.rigid_pairs);
  if (work.step > 0)
    travel.last_step = work.step;
  ++work.search.steps_since;
  ++work.rigid_pairs.steps;
  for (std::size_t b = 0; b < travel.travelled.size(); ++b)
    if (travel.travelled[b] > std::min(travel.skin[b], work.search.undefined_pair_margin))
      work.search.blocks_due = true;
  if (any_left_skin(work.rigid_pairs))
    work.search.pairs_due = true;
  return work.search.blocks_due || work.search.pairs_due;
}

// Marks the edges that have a contact before the step.
void mark_touched_edges(const Model& model, const std::vector<Contact>& contacts, const SurfaceEdges& edges,
                        EdgesTouched& touched) {
  touched.edges.assign(edges.all.size(), 0);
  touched.blocks.assign(model.blocks.size(), 0);
  const auto mark = [&](int id) {
    for (int e = edges.begin[id / 3]; e < edges.begin[id / 3 + 1]; ++e)
      if (edges.all[e].id() == id)
        touched.edges[e] = touched.blocks[model.surface.triangles[id / 3].block] = 1;
  };
  for (const Contact& c : contacts)
    if (c.kind == Contact::edge) {
      mark(static_cast<int>(c.source));
      mark(c.target);
    }
}

} // namespace

ContactSums contact_forces(const Model& model, State& state, ContactWork& own, int threads) {
  ContactSums sums;
  if (model.surface.empty() || !own.due)
    return sums;
  own.search.blocks_due = own.search.blocks_due || own.options.looks_at_all;
  std::fill(own.fragments.changed.begin(), own.fragments.changed.end(), 0);
  const bool out_of_skin = add_displacements(model, state, own, threads) || own.options.looks_at_all,
             fragments_due = own.search.fragments_due, known = own.search.history_complete,
             anew = own.search.anew;
  if (fragments_due || out_of_skin) {
    begin_search(state, own);
    tell_of_bonds(model, state, own.search.told_due);
    std::fill(own.search.told_due.begin(), own.search.told_due.end(), 0);
    if (!search_contacts(model, state, own, threads))
      return sums; // something is not a number: the stage's watch will say where
    read_nodes_of_rows(model, own);
  }
  find_tet_pairs(model, state, own, fragments_due);
  keep_own_contacts(model, state, own);
  own.any_depth_begins = !known;
  own.any_depth_of_broken = anew;
  // If a fragment has fallen apart, each contact stays with the part on which it acts.
  if (fragments_due) {
    const auto renew = [&](Contact& c) {
      if (c.kind == Contact::spring)
        c.fragment = own.fragments.of_triangle[c.target];
    };
    for (Contact& c : state.contacts)
      renew(c);
    for (OpenedContact& opened : state.opened_contacts)
      renew(opened.last);
    sort_by_key(state.contacts);
    sort_by_key(state.opened_contacts);
  }
  const auto springs = static_cast<std::int64_t>(own.rows[Contact::spring].all.size()),
             edges = static_cast<std::int64_t>(own.rows[Contact::edge].all.size());
  const auto chunks = [](std::int64_t rows) {
    return (rows + contact_rows_per_chunk - 1) / contact_rows_per_chunk;
  };
  const std::int64_t n_springs = chunks(springs);
  const std::int64_t n_chunks = n_springs + chunks(edges);
  own.chunks.resize(static_cast<std::size_t>(chunks_at_a_time * threads));
  mark_touched_edges(model, state.contacts, own.edges, own.edges_touched);
  if (own.damps)
    sum_block_forces(model, state, own);
  if (own.damps && own.knows_motions)
    find_block_motions(model, state, own, threads);
  find_awake(model, state, own);
  FoundContacts found(model, state, own);
  for (std::int64_t first = 0; first < n_chunks; first += chunks_at_a_time * threads) {
    const std::int64_t count = std::min(n_chunks - first, chunks_at_a_time * threads);
    for_chunks(count, threads, [&](std::int64_t i) {
      ContactChunk& out = own.chunks[i];
      out.contacts.clear();
      out.forces.clear();
      out.sums = {};
      const bool edge = first + i >= n_springs;
      const Contact::Kind kind = edge ? Contact::edge : Contact::spring;
      const std::int64_t begin = (edge ? first + i - n_springs : first + i) * contact_rows_per_chunk;
      ContactCandidate* const candidates = own.rows[kind].candidates.data();
      RowsAsleep& asleep = own.rows[kind].asleep;
      if (asleep.awake[begin / contact_rows_per_chunk] == 0)
        return;
      Evaluation evaluation(model, state, own, kind, out);
      for (std::uint64_t bits = asleep.awake[begin / contact_rows_per_chunk]; bits != 0; bits &= bits - 1) {
        const std::int64_t r = begin + __builtin_ctzll(bits);
        ContactRow& row = own.rows[kind].all[r];
        const bool hindered = row.hindered;
        if (!hindered && !own.options.looks_at_all && sleeps_on(model, own, row))
          continue;
        edge ? evaluation.edges(row, candidates) : evaluation.springs(row, candidates);
        if (row.pair >= 0)
          asleep.of_pairs.until[row.place] = row.recheck_distance;
        else
          asleep.recheck_distance[r] = row.several_blocks ? 0 : row.recheck_distance;
        if (row.hindered != hindered)
          asleep.hindered[begin / contact_rows_per_chunk] ^= bits & -bits;
      }
    });
    for (std::int64_t i = 0; i < count; ++i)
      found.add(own.chunks[i], first + i < n_springs ? Contact::spring : Contact::edge);
  }
  found.add(press_tets(model, state, own, threads));
  sums = found.end();
  own.due = false;
  own.step = 0;
  return sums;
}

double contact_energy(const Model& model, const State& state, double lag) {
  double sum = 0;
  for (const Contact& now : state.contacts) {
    const ContactLaw law = law_of(model, now);
    const geom::Vec3 ago = lag * velocity_past(state, arms_of(model, state, now));
    const double along = ago.dot(now.normal);
    Contact then = now;
    if (now.effective_penetration() > 0)
      then.depth = std::max(then.depth + along, then.reference_penetration);
    then.damping = part_damped(now, law) * law.kn *
                   std::clamp(pressed_by_approach(now, law, part_damped(now, law)) + along, 0.0,
                              then.effective_penetration());
    then.shear += law.ks * (ago - along * now.normal);
    const double limit = friction_limit(law.kn * then.effective_penetration(), law.tan_friction);
    then.shear *= held_by_friction(then.shear.norm(), limit);
    const double near_end = force_near_end(now.from_end) - 1;
    sum += energy(then, law) + near_end * law.kn * now.effective_penetration() * along +
           along_face(now, law).dot(ago);
  }
  return sum;
}

} // namespace cdem
