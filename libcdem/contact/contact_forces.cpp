#include "libcdem/contact/contact_forces.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"
#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/narrow_phase/evaluation.hpp"
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

// The furthest that a nodeof each mover goes in a step of this length. True when one has left its skin.
bool add_displacements(const Model& model, const State& state, ContactWork& work, int threads) {
  if (work.movers.count() == 0)
    return true; // not searched yet
  set_displacements(model, state, work, threads);
  for (std::size_t m = 0; m < work.travelled.size(); ++m)
    work.travelled[m] += work.last_displacement[m];
  for (std::size_t b = 0; b < work.path.size(); ++b) // rounded up
    if (work.last_displacement[b] > 0)
      work.path[b] =
          (work.path[b] + work.last_displacement[b]) * (1 + std::numeric_limits<double>::epsilon());
  set_poses(model, state, work);
  if (work.step > 0)
    work.last_step = work.step;
  ++work.steps_since_search;
  ++work.steps;
  set_drifts(model, state, work, threads);
  bool out = false;
  for (int m = 0; m < work.movers.count(); ++m) {
    const bool fragment = m >= static_cast<int>(model.blocks.size());
    if (!fragment && work.broken[m])
      continue;
    const double gone = gone_at_most(model, work, m);
    if (gone > work.undefined_pair_margin || (!fragment && gone > work.skin[m]))
      out = work.blocks_due = true;
  }
  if (any_left_skin(work))
    out = work.pairs_due = true;
  return find_leavers(model, work) || out;
}

// What contacts stored and did not give back that act no more, J: those that opened gave it back, the other side of the
// rest has gone round an edge or off the end of another. Both lists are sorted.
double lost(const Model& model, const State& state, const ContactWork& work) {
  std::vector<std::size_t> ended;
  const std::vector<Contact>& before = state.contacts;
  auto next = work.now.begin();
  for (std::size_t i = 0; i < before.size(); ++i) {
    while (next != work.now.end() && key(*next) < key(before[i]))
      ++next;
    if (next == work.now.end() || key(*next) != key(before[i]))
      ended.push_back(i);
  }
  const std::vector<double> losses = of_finders(work, ended, [&](std::size_t i) {
    const Contact& c = before[i];
    return end_loss(c, law_of(model, c), work.step * velocity_past(state, arms_of(model, state, c)));
  });
  double energy_lost = 0;
  for (const double loss : losses)
    energy_lost += loss;
  return energy_lost;
}

// Serial, as it is little beside finding them.
void clear_forces(ContactWork& work) {
  for (const TouchedNode& at : work.touched) {
    work.force[at.node] = {};
    work.stiffness[at.node] = 0;
  }
  work.touched.clear();
}

void add_forces(const std::vector<ContactForce>& forces, ContactWork& own) {
  const auto add = [&](int node, int block, const geom::Vec3& force, double stiffness) {
    Node& sum = own.force[node];
    sum.x += force.x();
    sum.y += force.y();
    sum.z += force.z();
    if (own.stiffness[node] == 0 && stiffness != 0)
      own.touched.push_back({node, block});
    own.stiffness[node] += 2 * stiffness; // the weights of both sides sum to 2
  };
  for (const ContactForce& f : forces) {
    const ContactArms& arms = f.arms;
    for (int i = 0; i < 3; ++i)
      if (arms.on_source[i] != 0)
        add(arms.source[i], f.source_block, arms.on_source[i] * (f.normal + f.shear),
            arms.on_source[i] * f.stiffness);
    for (int i = 0; i < 4; ++i)
      add(arms.target[i], f.target_block, -arms.normal[i] * f.normal - arms.shear[i] * f.shear,
          std::max(arms.normal[i], std::abs(arms.shear[i])) * f.stiffness);
  }
}

// Marks the edges that have a contact before the step.
void mark_touched_edges(const std::vector<Contact>& contacts, ContactWork& work) {
  std::fill(work.edge_touched.begin(), work.edge_touched.end(), 0);
  work.mover_edges_touched.assign(work.movers.count(), 0);
  const auto mark = [&](int id) {
    for (int e = work.edge_begin[id / 3]; e < work.edge_begin[id / 3 + 1]; ++e)
      if (work.edges[e].id() == id)
        work.edge_touched[e] = work.mover_edges_touched[work.movers.of_triangle[id / 3]] = 1;
  };
  for (auto c = contacts.rbegin(); c != contacts.rend() && c->kind == Contact::edge; ++c) {
    mark(static_cast<int>(c->source));
    mark(c->target);
  }
}

// N, of the springs on each block, before the step.
void sum_block_forces(const Model& model, const std::vector<Contact>& contacts, ContactWork& work) {
  work.block_forces.assign(model.blocks.size(), 0.0);
  for (const Contact& c : contacts) {
    const double force = law_of(model, c).kn * c.effective_penetration();
    const auto [a, b] = blocks_of(model, c);
    work.block_forces[a] += force;
    work.block_forces[b] += force;
  }
}

// Those of one source stand by fragment, then corner: next to their places.
void add_sorted(const std::vector<Contact>& found, int rank, ContactWork& work) {
  std::vector<Contact>& contacts = work.now;
  for (const Contact& c : found) {
    contacts.push_back(c);
    if (work.shared)
      work.rank_now.push_back(rank);
    for (std::size_t i = contacts.size() - 1; i > 0 && key(contacts[i]) < key(contacts[i - 1]); --i) {
      std::swap(contacts[i], contacts[i - 1]);
      if (work.shared)
        std::swap(work.rank_now[i], work.rank_now[i - 1]);
    }
  }
}

// Takes over what a chunk found, or a rank.
void take(const ContactChunk& found, int rank, ContactWork& work, ContactSums& sums) {
  add_sorted(found.contacts, rank, work);
  add_forces(found.forces, work);
  for (const ContactForce& force : found.forces) {
    sums.friction += force.friction;
    sums.damping += force.damping;
  }
  add_depths(found.sums, sums);
}

} // namespace

ContactSums contact_forces(const Model& model, State& state, ContactWork& own, int threads) {
  ContactSums sums;
  if (model.surface.empty() || !own.due)
    return sums;
  own.blocks_due = own.blocks_due || own.looks_at_all;
  const bool out_of_skin = add_displacements(model, state, own, threads) || own.looks_at_all,
             fragments_due = own.fragments_due, known = own.history_complete, anew = own.anew;
  if (fragments_due || out_of_skin) {
    begin_search(state, own);
    if (!search_contacts(model, state, own, threads))
      return sums; // something is not a number: the stage's watch will say where
    read_nodes_of_rows(model, own);
  }
  own.any_depth_begins = !known || (anew && any_bonded_faces(model, state));
  if (!fragments_due)
    std::fill(own.changed.begin(), own.changed.end(), 0);
  // If a fragment has fallen apart, each contact stays with the part on which it acts.
  if (fragments_due) {
    for (Contact& c : state.contacts)
      if (c.kind == Contact::spring)
        c.fragment = own.fragment[c.target];
    std::sort(state.contacts.begin(), state.contacts.end(),
              [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  }
  const auto springs = static_cast<std::int64_t>(own.rows[Contact::spring].size()),
             edges = static_cast<std::int64_t>(own.rows[Contact::edge].size());
  const auto chunks = [](std::int64_t rows) {
    return (rows + contact_rows_per_chunk - 1) / contact_rows_per_chunk;
  };
  const std::int64_t n_springs = chunks(springs);
  const std::int64_t n_chunks = n_springs + chunks(edges);
  own.chunks.resize(static_cast<std::size_t>(chunks_at_a_time * threads));
  clear_forces(own);
  mark_touched_edges(state.contacts, own);
  if (own.restitution) {
    sum_block_forces(model, state.contacts, own);
    find_block_motions(model, state, own, threads);
  }
  find_awake(model, state, own);
  own.now.clear();
  own.rank_now.clear();
  own.now.reserve(state.contacts.size() + state.contacts.size() / 8 + 64);
  std::array<ContactChunk, 2> found; // springs and edges, by this rank, where there are others
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
      ContactCandidate* const candidates = own.candidates[kind].data();
      Evaluation evaluation(model, state, own, kind, out);
      RowsAsleep& asleep = own.asleep[kind];
      for (std::uint64_t bits = asleep.awake[begin / contact_rows_per_chunk]; bits != 0; bits &= bits - 1) {
        const std::int64_t r = begin + __builtin_ctzll(bits);
        ContactRow& row = own.rows[kind][r];
        const bool hindered = row.hindered;
        if (!hindered && !own.looks_at_all && sleeps_on(own, row, asleep.recheck_distance[r]))
          continue;
        edge ? evaluation.edges(row, candidates) : evaluation.springs(row, candidates);
        if (row.pair >= 0)
          asleep.of_pairs.until[row.place] = row.recheck_distance;
        else
          fall_asleep(own, static_cast<int>(model.blocks.size()), row, asleep.recheck_distance[r]);
        if (row.hindered != hindered)
          asleep.hindered[begin / contact_rows_per_chunk] ^= bits & -bits;
      }
    });
    for (std::int64_t i = 0; i < count; ++i)
      own.shared ? append(own.chunks[i], found[first + i < n_springs ? Contact::spring : Contact::edge])
                 : take(own.chunks[i], 0, own, sums);
  }
  if (own.shared)
    for (const std::vector<ContactChunk>& by_rank : found_by_all(found))
      for (std::size_t rank = 0; rank < by_rank.size(); ++rank)
        take(by_rank[rank], static_cast<int>(rank), own, sums);
  sums.friction += lost(model, state, own);
  if (own.now.capacity() > 2 * own.now.size() + 64)
    own.now.shrink_to_fit();
  std::swap(state.contacts, own.now);
  std::swap(own.rank_of_contact, own.rank_now);
  own.due = false;
  own.step = 0;
  return sums;
}

double contact_energy(const Model& model, const State& state, double lag) {
  double sum = 0;
  for (const Contact& c : state.contacts) {
    const ContactLaw law = law_of(model, c);
    const geom::Vec3 ago = lag * velocity_past(state, arms_of(model, state, c));
    const double along = ago.dot(c.normal);
    const double pressed =
        c.effective_penetration() > 0 ? std::max(0.0, c.effective_penetration() + along) : 0;
    const double shear_force = (c.shear + law.ks * (ago - along * c.normal)).norm();
    sum += energy(pressed, std::min(shear_force, friction_limit(law.kn * pressed, law.tan_friction)), law);
  }
  return sum;
}

} // namespace cdem
