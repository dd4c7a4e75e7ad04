#include "libcdem/contact/found_contacts.hpp"

#include "libcdem/contact/data/row_owner.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/response/block_motion.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/ranks/bytes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace cdem {
namespace {

void add_exactly(const geom::Vec3& more, std::array<ExactSum, 3>& sums) {
  for (int axis = 0; axis < 3; ++axis)
    sums[axis].add(more[axis]);
}

// The deepest; of equals the one of the first triangle, whichever rank has found it.
void add_depths(const ContactSums& more, ContactSums& sums) {
  sums.depth = std::max(sums.depth, more.depth);
  sums.depth_over_height = std::max(sums.depth_over_height, more.depth_over_height);
  if (std::tuple(-more.deepest, more.deepest_source, more.deepest_target) <
      std::tuple(-sums.deepest, sums.deepest_source, sums.deepest_target))
    std::tie(sums.deepest, sums.deepest_source, sums.deepest_target) =
        std::tuple(more.deepest, more.deepest_source, more.deepest_target);
}

// One at a corner of the tetrahedron; of its block, where it has none.
int triangle_beside(const Model& model, int tet) {
  const ContactSurface& s = model.surface;
  const geom::Tet& nodes = model.tets[tet];
  const int block = model.tet_block[tet];
  for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
    if (std::find_first_of(s.triangles[t].nodes.begin(), s.triangles[t].nodes.end(), nodes.begin(),
                           nodes.end()) != s.triangles[t].nodes.end())
      return t;
  return s.block_begin[block];
}

bool stands_before(const Contact& a, const Contact& b) {
  return key(a) < key(b);
}

// Those of one source stand by fragment, then corner: next to their places.
void insert(const Contact& c, std::vector<Contact>& contacts) {
  contacts.push_back(c);
  for (std::size_t i = contacts.size() - 1; i > 0 && stands_before(contacts[i], contacts[i - 1]); --i)
    std::swap(contacts[i], contacts[i - 1]);
}

} // namespace

FoundContacts::FoundContacts(const Model& model, State& state, ContactWork& work)
    : model_(model), state_(state), work_(work) {
  for (const TouchedNode& at : work.loads.touched) {
    work.loads.force[at.node] = {};
    work.loads.stiffness[at.node] = 0;
  }
  work.loads.touched.clear();
  for (RigidSums& sums : work.loads.rigid_sums)
    if (sums.touches) {
      sums.each([](ExactSum& sum) { sum.clear(); });
      sums.touches = false;
    }
  work.now.clear();
  work.now.reserve(state.contacts.size() + state.contacts.size() / 8 + 64);
}

void FoundContacts::add(const ContactChunk& found, Contact::Kind kind) {
  add_depths(found.sums, sums_);
  for (std::size_t i = 0; i < found.contacts.size(); ++i)
    add(found.contacts[i], found.forces[i], kind);
}

void FoundContacts::add(std::vector<TetChunk> found) {
  tets_ = std::move(found);
  const bool counts = work_.shared->part().rank == 0; // else another rank does
  for (const TetChunk& chunk : tets_) {
    sums_.depth = std::max(sums_.depth, chunk.depth);
    sums_.depth_over_height = std::max(sums_.depth_over_height, chunk.depth_over_height);
    if (const double part = chunk.depth_over_height / depth_ratio; part > 1 && part > sums_.deepest) {
      sums_.deepest = part;
      sums_.deepest_source = triangle_beside(model_, chunk.deepest[0]);
      sums_.deepest_target = triangle_beside(model_, chunk.deepest[1]);
    }
    if (!counts)
      continue;
    for (const double lost : chunk.friction)
      friction_.add(lost);
    for (const double lost : chunk.damping)
      damping_.add(lost);
    sums_.contacts += static_cast<std::int64_t>(chunk.forces.size());
  }
}

// After all others, as they stand in State.
void FoundContacts::add_tets() {
  for (const TetChunk& chunk : tets_) {
    work_.now.insert(work_.now.end(), chunk.contacts.begin(), chunk.contacts.end());
    for (const TetPairForce& force : chunk.forces)
      for (int k = 0; k < 8; ++k)
        add_at_node(force.node[k], force.block, force.force[k], force.stiffness[k]);
  }
}

void FoundContacts::add(const Contact& contact, const ContactForce& force, Contact::Kind kind) {
  ++sums_.contacts;
  friction_.add(force.friction);
  damping_.add(force.damping);
  insert(contact, work_.now);
  add_on_rigid(force);
  if (both_rigid(model_, force.source_block, force.target_block))
    return;
  if (work_.shared->alone()) {
    add_at_nodes(force);
    return;
  }
  told_[kind].push_back(force);
}

void FoundContacts::add_at_node(int node, int block, const geom::Vec3& force, double stiffness) {
  Node& sum = work_.loads.force[node];
  sum.x += force.x();
  sum.y += force.y();
  sum.z += force.z();
  if (work_.loads.stiffness[node] == 0 && stiffness != 0)
    work_.loads.touched.push_back({node, block});
  work_.loads.stiffness[node] += 2 * stiffness; // the weights of both sides sum to 2
}

void FoundContacts::add_at_nodes(const ContactForce& f) {
  const ContactArms& arms = f.arms;
  if (model_.blocks[f.source_block].rigid < 0)
    for (int i = 0; i < 4; ++i)
      if (arms.on_source[i] != 0)
        add_at_node(arms.source[i], f.source_block, arms.on_source[i] * (f.normal + f.shear),
                    std::abs(arms.on_source[i]) * f.stiffness);
  if (model_.blocks[f.target_block].rigid < 0)
    for (int i = 0; i < 4; ++i)
      add_at_node(arms.target[i], f.target_block, -arms.normal[i] * f.normal - arms.shear[i] * f.shear,
                  std::max(arms.normal[i], std::abs(arms.shear[i])) * f.stiffness);
  if (f.moment.isZero(0))
    return;
  const auto turn = [&](const geom::Tet& tet, int block, const geom::Vec3& moment) {
    if (model_.blocks[block].rigid >= 0)
      return;
    const std::array<geom::Vec3, 4> forces = forces_of_moment(model_, state_, tet, moment);
    for (int i = 0; i < 4; ++i)
      add_at_node(tet[i], block, forces[i], 0);
  };
  turn(arms.source, f.source_block, f.moment);
  turn(arms.target, f.target_block, -f.moment);
}

RigidSums& FoundContacts::touched(int rigid) {
  work_.loads.rigid_sums[rigid].touches = true;
  return work_.loads.rigid_sums[rigid];
}

// Forces at nodes move and turn the body as their resultant does; stiffness counts as if each node moved by itself.
void FoundContacts::add_on_rigid(const ContactForce& f) {
  const ContactArms& arms = f.arms;
  const auto arm = [&](int node, int rigid) -> geom::Vec3 {
    return place_of(model_, state_, node) - vec(state_.rigid[rigid].centroid);
  };
  if (const int rigid = model_.blocks[f.source_block].rigid; rigid >= 0) {
    geom::Vec3 at = geom::Vec3::Zero();
    double frequency2 = 0;
    for (int i = 0; i < 4; ++i)
      if (arms.on_source[i] != 0) {
        const geom::Vec3 here = arm(arms.source[i], rigid);
        at += arms.on_source[i] * here;
        frequency2 += std::abs(arms.on_source[i]) * rigid_inverse_mass(model_.rigid[rigid], here.norm());
      }
    RigidSums& sums = touched(rigid);
    add_exactly(f.normal + f.shear, sums.force);
    add_exactly(at.cross(f.normal + f.shear) + f.moment, sums.torque);
    sums.frequency2.add(2 * f.stiffness * frequency2);
  }
  if (const int rigid = model_.blocks[f.target_block].rigid; rigid >= 0) {
    geom::Vec3 pressed = geom::Vec3::Zero(), sheared = geom::Vec3::Zero();
    double frequency2 = 0;
    for (int i = 0; i < 4; ++i) {
      const geom::Vec3 here = arm(arms.target[i], rigid);
      pressed += arms.normal[i] * here;
      sheared += arms.shear[i] * here;
      frequency2 += std::max(arms.normal[i], std::abs(arms.shear[i])) *
                    rigid_inverse_mass(model_.rigid[rigid], here.norm());
    }
    RigidSums& sums = touched(rigid);
    add_exactly(-f.normal - f.shear, sums.force);
    add_exactly(-pressed.cross(f.normal) - sheared.cross(f.shear) - f.moment, sums.torque);
    sums.frequency2.add(2 * f.stiffness * frequency2);
  }
}

// The contacts of before and those of now are sorted.
void FoundContacts::find_ended() {
  ended_.clear();
  auto next = work_.now.cbegin();
  for (const Contact& c : state_.contacts) {
    while (next != work_.now.cend() && stands_before(*next, c))
      ++next;
    if (c.kind != Contact::tets && (next == work_.now.cend() || key(*next) != key(c)))
      ended_.push_back(&c);
  }
}

// What contacts stored and did not give back that act no more: those that opened gave it back, the other side of the rest
// has gone round an edge or off the end of another.
void FoundContacts::add_losses() {
  for (const Contact* const c : ended_)
    if (keeps(model_, work_, *c))
      friction_.add(
          end_loss(*c, law_of(model_, *c), work_.step * velocity_past(state_, arms_of(model_, state_, *c))));
}

// All ranks know all contacts of deformable bodies.
void FoundContacts::remember_opened() {
  std::vector<OpenedContact>& all = state_.opened_contacts;
  if (!work_.damps) {
    all.clear();
    return;
  }
  for (OpenedContact& opened : all)
    opened.left -= work_.step;
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const OpenedContact& opened) {
                             return !(opened.left > 0) ||
                                    std::binary_search(work_.now.begin(), work_.now.end(), opened.last,
                                                       stands_before);
                           }),
            all.end());
  for (const Contact* const c : ended_)
    if (c->at_rest > 0 && !is_told_by_sums(model_, *c)) {
      const auto [a, b] = blocks_of(model_, *c);
      if (const double frequency = frequency_on_contacts(model_, work_, a, b); frequency > 0)
        all.push_back({*c, time_of_opening / frequency});
    }
  sort_by_key(all);
}

// A rank keeps the rows of a run of triangles. So the forces of all ranks, rank by rank, stand in the order of all rows,
// and the contacts, of which each rank tells its own by key, stand by key.
void FoundContacts::exchange() {
  struct Told { // contacts of what deforms, per kind
    std::array<std::vector<Contact>, 2> contacts;
    std::array<std::vector<ContactForce>, 2> forces;
  };
  Pack pack;
  pack(sums_);
  friction_.tell(pack);
  damping_.tell(pack);
  Told own;
  std::swap(own.forces, told_);
  for (const Contact& c : work_.now)
    if (!is_told_by_sums(model_, c))
      own.contacts[c.kind].push_back(c);
  for (const Contact::Kind kind : {Contact::spring, Contact::edge}) {
    pack(own.contacts[kind]);
    pack(own.forces[kind]);
  }
  for (std::size_t rigid = 0; rigid < work_.loads.rigid_sums.size(); ++rigid)
    if (RigidSums& sums = work_.loads.rigid_sums[rigid]; sums.touches) {
      pack(static_cast<int>(rigid));
      sums.each([&](const ExactSum& sum) { sum.tell(pack); });
    }
  pack(-1);
  const int here = work_.shared->part().rank;
  const std::vector<std::string> heard = ranks().gather(pack.text(), Ranks::Subject::contacts);
  std::vector<Told> told_by(heard.size());
  for (int rank = 0; rank < static_cast<int>(heard.size()); ++rank) {
    if (rank == here) {
      std::swap(told_by[rank], own);
      continue;
    }
    Unpack unpack(heard[rank]);
    ContactSums sums;
    unpack(sums);
    add_depths(sums, sums_);
    sums_.contacts += sums.contacts;
    friction_.add_told(unpack);
    damping_.add_told(unpack);
    for (const Contact::Kind kind : {Contact::spring, Contact::edge}) {
      unpack(told_by[rank].contacts[kind]);
      unpack(told_by[rank].forces[kind]);
    }
    for (int rigid = 0;;) {
      unpack(rigid);
      if (rigid < 0)
        break;
      touched(rigid).each([&](ExactSum& sum) { sum.add_told(unpack); });
    }
  }
  const auto found_here = static_cast<std::ptrdiff_t>(work_.now.size());
  for (const Contact::Kind kind : {Contact::spring, Contact::edge})
    for (int rank = 0; rank < static_cast<int>(told_by.size()); ++rank) {
      const std::vector<Contact>& contacts = told_by[rank].contacts[kind];
      for (const ContactForce& force : told_by[rank].forces[kind])
        add_at_nodes(force);
      if (rank != here)
        work_.now.insert(work_.now.end(), contacts.begin(), contacts.end());
    }
  std::inplace_merge(work_.now.begin(), work_.now.begin() + found_here, work_.now.end(), stands_before);
}

// Forces only of bodies that this rank moves.
void FoundContacts::set_values() {
  sums_.friction = friction_.value();
  sums_.damping = damping_.value();
  for (std::size_t rigid = 0; rigid < work_.loads.rigid_sums.size(); ++rigid) {
    RigidSums& sums = work_.loads.rigid_sums[rigid];
    ContactOnRigid& on = work_.loads.on_rigid[rigid];
    on = {};
    if (!sums.touches)
      continue;
    on.touches = true;
    on.frequency2 = sums.frequency2.value();
    if (!work_.shared->moves(static_cast<int>(rigid)))
      continue;
    on.force = values(sums.force);
    on.torque = values(sums.torque);
  }
}

ContactSums FoundContacts::end() {
  find_ended();
  add_losses();
  if (!work_.shared->alone()) {
    exchange();
    find_ended();
  }
  remember_opened();
  add_tets();
  set_values();
  assert(std::is_sorted(work_.now.begin(), work_.now.end(), stands_before));
  if (work_.now.capacity() > 2 * work_.now.size() + 64)
    work_.now.shrink_to_fit();
  std::swap(state_.contacts, work_.now);
  work_.shared->part_contacts(state_);
  return sums_;
}

} // namespace cdem
