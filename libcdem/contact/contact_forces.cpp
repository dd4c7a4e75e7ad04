#include "libcdem/contact/contact_forces.hpp"

#include "libcdem/contact/acting.hpp"
#include "libcdem/contact/evaluation.hpp"
#include "libcdem/contact/places.hpp"
#include "libcdem/contact/search.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// The furthest that a node of each block goes in a step of this length.
void add_ways(const Model& model, const State& state, ContactWork& work, int threads) {
  const auto blocks = static_cast<std::int64_t>(model.blocks.size());
  for_chunks(blocks, threads, [&](std::int64_t b) {
    const Block& block = model.blocks[b];
    if (!block.meshed)
      return;
    double speed2 = 0;
    for (int node = block.node_begin; node < block.node_end; ++node)
      speed2 = std::max(speed2, velocity_of(state, node).squaredNorm());
    work.last_way[b] = std::sqrt(speed2) * work.step;
    work.travelled[b] += work.last_way[b];
  });
  work.furthest = *std::max_element(work.travelled.begin(), work.travelled.end());
}

void sort_by_key(std::vector<Contact>& contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& a, const Contact& b) { return key(a) < key(b); });
}

// What contacts stored that act no more, J: their other side has gone round an edge or off the end of another. Both lists
// are sorted.
double lost(const Model& model, const std::vector<Contact>& before, const std::vector<Contact>& now) {
  double energy_lost = 0;
  auto next = now.begin();
  for (const Contact& c : before) {
    while (next != now.end() && key(*next) < key(c))
      ++next;
    if (next == now.end() || key(*next) != key(c))
      energy_lost += energy(c.normal_force, c.shear.norm(), law_of(model, c));
  }
  return energy_lost;
}

// Adds the forces in the order of the contacts: serial, as it is little beside finding them.
void add_forces(const ContactWork& found, Workspace& work) {
  ContactWork& own = work.meeting;
  for (const int node : own.touched) {
    work.contact[node] = {};
    own.stiffness[node] = 0;
  }
  own.touched.clear();
  const auto add = [&](int node, const geom::Vec3& force, double stiffness) {
    Node& sum = work.contact[node];
    sum.x += force.x();
    sum.y += force.y();
    sum.z += force.z();
    if (own.stiffness[node] == 0 && stiffness != 0)
      own.touched.push_back(node);
    own.stiffness[node] += 2 * stiffness; // the weights of both sides sum to 2
  };
  for (const ContactChunk& chunk : found.chunks)
    for (const ContactForce& f : chunk.forces) {
      const ContactArms& arms = f.arms;
      for (int i = 0; i < 3; ++i)
        if (arms.on_source[i] != 0)
          add(arms.source[i], arms.on_source[i] * (f.normal + f.shear), arms.on_source[i] * f.stiffness);
      for (int i = 0; i < 4; ++i)
        add(arms.target[i], -arms.normal[i] * f.normal - arms.shear[i] * f.shear,
            std::max(arms.normal[i], std::abs(arms.shear[i])) * f.stiffness);
    }
}

} // namespace

ContactSums contact_forces(const Model& model, State& state, Workspace& work, int threads) {
  ContactSums sums;
  ContactWork& own = work.meeting;
  if (model.surface.empty() || !own.due)
    return sums;
  add_ways(model, state, own, threads);
  if ((own.search_due || own.furthest > 0.5 * own.skin) && !search_contacts(model, state, own, threads))
    return sums; // something is not a number: the stage's watch will say where
  // Where a piece has fallen apart, contacts go with the part they touch.
  for (Contact& c : state.contacts)
    if (c.kind == Contact::spring)
      c.piece = own.piece[c.target];
  sort_by_key(state.contacts);
  const auto springs = static_cast<std::int64_t>(own.rows[Contact::spring].size()),
             edges = static_cast<std::int64_t>(own.rows[Contact::edge].size());
  const std::vector<Range> spring_chunks = split(springs, contact_rows_per_chunk),
                           edge_chunks = split(edges, contact_rows_per_chunk);
  const auto n_springs = static_cast<std::int64_t>(spring_chunks.size());
  for_chunks(static_cast<std::int64_t>(own.chunks.size()), threads, [&](std::int64_t i) {
    ContactChunk& out = own.chunks[i];
    out.contacts.clear();
    out.forces.clear();
    out.friction = 0;
    const Contact::Kind kind = i < n_springs ? Contact::spring : Contact::edge;
    const Range range = i < n_springs ? spring_chunks[i] : edge_chunks[i - n_springs];
    ContactCandidate* const candidates = own.candidates[kind].data();
    for (std::int64_t r = range.begin; r < range.end; ++r)
      if (kind == Contact::spring)
        evaluate_springs(model, state, own, own.rows[kind][r], candidates, out);
      else
        evaluate_edges(model, state, own, own.rows[kind][r], candidates, out);
  });
  std::vector<Contact> now;
  now.reserve(state.contacts.size());
  for (const ContactChunk& chunk : own.chunks) {
    now.insert(now.end(), chunk.contacts.begin(), chunk.contacts.end());
    sums.friction += chunk.friction;
  }
  sort_by_key(now); // a row goes by piece, then corner
  if (own.step > 0)
    sums.friction += lost(model, state.contacts, now);
  state.contacts = std::move(now);
  for (const Contact& c : state.contacts) {
    const auto [source, target] = triangles_of(model, c);
    const ContactTriangle &from = model.surface.triangles[source], &to = model.surface.triangles[target];
    // Not what was found so deep: between the pieces of a broken body that still hang together by a corner.
    const double pressed = c.depth - c.start, part = pressed / depth_limit(own, from, to);
    sums.depth = std::max(sums.depth, pressed);
    sums.depth_over_height = std::max(sums.depth_over_height, pressed / std::min(from.height, to.height));
    if (part > sums.deepest) {
      sums.deepest = part;
      sums.deepest_source = source;
      sums.deepest_target = target;
    }
  }
  add_forces(own, work);
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
    const double normal_force = std::max(0.0, c.normal_force + law.kn * along);
    const double shear_force = (c.shear + law.ks * (ago - along * c.normal)).norm();
    sum += energy(c.normal_force > 0 ? normal_force : 0,
                  std::min(shear_force, normal_force * law.tan_friction), law);
  }
  return sum;
}

} // namespace cdem
