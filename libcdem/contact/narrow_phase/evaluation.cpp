#include "libcdem/contact/narrow_phase/evaluation.hpp"

#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// What is nearer than this many times the deepest contact of a row is looked at in every step.
constexpr double reach_over_depth = 1.5;

} // namespace

Evaluation::Evaluation(const Model& model, const State& state, const ContactWork& work, Contact::Kind kind,
                       ContactChunk& out)
    : model_(model), surface_(model.surface), state_(state), work_(work), kind_(kind), out_(out),
      lines_(model, state, work), old_(state.contacts.end()) {}

void Evaluation::springs(ContactRow& row, ContactCandidate* candidates) {
  if (row.reach > 0 && may_skip(row, surface_.triangles[row.source].block))
    return;
  go_to(3 * row.source);
  const std::size_t contacts = out_.contacts.size(), forces = out_.forces.size();
  const ContactSums sums = out_.sums;
  const bool all = row.reach == 0;
  const auto shallow = static_cast<float>(
      std::min(work_.shallow[surface_.triangles[row.source].block], work_.shallow[row.block]));
  row.reach = std::max(row.reach, shallow);
  double deepest = narrow_phase(row, candidates, all);
  while (deepest > row.reach) {
    out_.contacts.resize(contacts);
    out_.forces.resize(forces);
    out_.sums = sums;
    row.reach = static_cast<float>(reach_over_depth * deepest);
    deepest = narrow_phase(row, candidates, true);
  }
  row.reach = std::max(shallow, std::min(row.reach, static_cast<float>(reach_over_depth * deepest)));
}

const Evaluation::Law& Evaluation::law_between(int block_a, int block_b) {
  const std::pair bodies(model_.blocks[block_a].body, model_.blocks[block_b].body);
  if (law_.bodies != bodies) {
    const Joint* const joint = contact_joint(model_, block_a, block_b);
    law_ = {bodies, joint, std::min(geom::portable::tan(joint->friction_angle), work_.most_friction)};
  }
  return law_;
}

bool Evaluation::may_skip(const ContactRow& row, int block) const {
  return work_.travelled[block] + work_.travelled[row.block] < row.recheck_distance;
}

void Evaluation::go_to(int source) {
  const auto stands_before = [&](const Contact& c) {
    return c.kind < kind_ || (c.kind == kind_ && static_cast<int>(c.source) < source);
  };
  if (old_ == state_.contacts.end())
    old_ = std::partition_point(state_.contacts.begin(), state_.contacts.end(), stands_before);
  while (old_ != state_.contacts.end() && stands_before(*old_))
    ++old_;
}

const Contact* Evaluation::before(const Contact& like) const {
  for (auto c = old_; c != state_.contacts.end() && key(*c) <= key(like); ++c)
    if (key(*c) == key(like))
      return &*c;
  return nullptr;
}

namespace {

// The distances of one semi-spring from its targets, as a search for the nearest goes through them.
struct Distances {
  double least = std::numeric_limits<double>::infinity(), second = least; // m
  double tet = 0;                                                         // m, the highest behind a target
  int target = -1;                                                        // the nearest

  void add(double distance, int of, double height) {
    tet = std::max(tet, height);
    second = std::min(second, std::max(least, distance));
    if (distance < least) {
      least = distance;
      target = of;
    }
  }
  // A target that sleeps is at least so far off.
  void add_asleep(double distance, double height) {
    tet = std::max(tet, height);
    second = std::min(second, distance);
  }
};

} // namespace

const Facet& Evaluation::facet(int triangle) {
  const auto slot = static_cast<std::size_t>(triangle) % facets_.size();
  Facet& facet = facets_[slot];
  if (facet_of_[slot] != triangle) {
    facet_of_[slot] = triangle;
    facet.x = corners_of(model_, state_, surface_.triangles[triangle].nodes);
    facet.normal = unit_normal(facet.x);
  }
  return facet;
}

Nearest Evaluation::nearest_on(int target, const geom::Vec3& spring, bool bonded) {
  const Facet& y = facet(target);
  Nearest nearest;
  take_nearer(nearest, nearest_of(target, spring, y.x, y.normal), y.x, y.normal,
              surface_.triangles[target].height, bonded);
  return nearest;
}

void Evaluation::find_nearest(ContactRow& row, ContactCandidate* candidates, bool all, const Springs& spring,
                              std::array<Nearest, 3>& nearest) {
  const double moved = work_.travelled[surface_.triangles[row.source].block] + work_.travelled[row.block];
  const bool bonded = has_bonds(model_, row.block);
  std::array<Distances, 3> distances;
  float recheck_distance = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
    ContactCandidate& candidate = candidates[i];
    const auto target = static_cast<int>(candidate.target);
    const ContactTriangle& triangle = surface_.triangles[target];
    if (!all && moved < candidate.recheck_distance) {
      recheck_distance = std::min(recheck_distance, candidate.recheck_distance);
      for (int corner = 0; corner < 3; ++corner)
        if (candidate.springs >> corner & 1u)
          distances[corner].add_asleep(row.reach + candidate.recheck_distance - moved, triangle.height);
      continue;
    }
    const Facet& y = facet(target);
    double least2 = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 3; ++corner) {
      if ((candidate.springs >> corner & 1u) == 0)
        continue;
      const Nearest found = nearest_of(target, spring[corner], y.x, y.normal);
      least2 = std::min(least2, found.distance2);
      distances[corner].add(std::sqrt(found.distance2), target, triangle.height);
      take_nearer(nearest[corner], found, y.x, y.normal, triangle.height, bonded);
    }
    candidate.recheck_distance = rounded_down(moved + std::max(0.0, std::sqrt(least2) - row.reach));
    recheck_distance = std::min(recheck_distance, candidate.recheck_distance);
  }
  row.recheck_distance = recheck_distance;
  for (int corner = 0; corner < 3; ++corner) {
    const Distances& d = distances[corner];
    const double least = std::min(d.least, d.second);
    if (std::isinf(least)) { // no target of the row is one of this spring
      row.known_target[corner] = -1;
      row.known_until[corner] = std::numeric_limits<float>::infinity();
      continue;
    }
    // Places nearer to each other than this may count as one.
    const double one_place = (bonded ? bond_gives : same_place_at_least) * d.tet + 4 * same_place * least;
    double until = 0;
    if (nearest[corner].inside()) {
      row.known_target[corner] = d.target;
      if (d.target == nearest[corner].target)
        until = 0.5 * (d.second * (1 - 4 * same_place) - least - one_place);
    } else {
      // What is outside gets in through the surface. A broken one has holes: what is near it may be inside beyond an edge.
      row.known_target[corner] = -1;
      until = least - 4 * one_place - (work_.broken[row.block] ? work_.shallow[row.block] : 0);
    }
    row.known_until[corner] = rounded_down(moved + std::max(0.0, until));
  }
}

double Evaluation::narrow_phase(ContactRow& row, ContactCandidate* candidates, bool all) {
  const ContactTriangle& source = surface_.triangles[row.source];
  const Corners x = corners_of(model_, state_, source.nodes);
  Springs spring;
  for (int corner = 0; corner < 3; ++corner)
    spring[corner] = weighted(x, spring_weights(corner));
  const double moved = work_.travelled[source.block] + work_.travelled[row.block];
  std::array<Nearest, 3> nearest;
  if (all || moved >= *std::min_element(row.known_until.begin(), row.known_until.end())) {
    find_nearest(row, candidates, all, spring, nearest);
  } else {
    const bool bonded = has_bonds(model_, row.block);
    row.recheck_distance = std::numeric_limits<float>::infinity();
    for (int corner = 0; corner < 3; ++corner)
      if (row.known_target[corner] < 0) {
        row.recheck_distance = std::min(row.recheck_distance, row.known_until[corner]);
      } else {
        nearest[corner] = nearest_on(row.known_target[corner], spring[corner], bonded);
        row.recheck_distance = 0;
      }
  }
  double deepest2 = 0;
  for (int corner = 0; corner < 3; ++corner) {
    const Nearest& found = nearest[corner];
    if (!found.inside())
      continue;
    // With some asleep, what is further in than a step can have brought it is not inside: nearer ones sleep.
    const double ways = work_.last_displacement[source.block] + work_.last_displacement[row.block],
                 reach = row.reach + ways;
    if (!all && found.distance2 > reach * reach)
      continue;
    const double covered = 2 * depth_limit(work_, source, surface_.triangles[found.target]);
    if (found.distance2 > covered * covered)
      continue; // beyond what the search covers: nearer ones may not be in the row
    // What is deep and was no contact before has come there by no motion, as at the mouth of a crack. Steps with some
    // asleep do not see it: it would begin where a search happens to be.
    const double begins = std::min(work_.shallow[source.block], work_.shallow[row.block]) + ways;
    const bool may_begin = work_.any_depth_begins || found.distance2 <= begins * begins;
    if (add_contact(row.source, corner, spring[corner], work_.fragment[found.target], found, may_begin))
      deepest2 = std::max(deepest2, found.distance2);
  }
  return std::sqrt(deepest2);
}

bool Evaluation::add_contact(int source, int corner, const geom::Vec3& spring, int fragment,
                             const Nearest& nearest, bool may_begin) {
  const ContactTriangle &from = surface_.triangles[source], &to = surface_.triangles[nearest.target];
  const double depth = std::sqrt(nearest.distance2);
  // The two sides of a face that has broken and not yet parted are held by its own springs.
  if (from.mate == nearest.target && !handed_over(state_.faces[from.face / lanes], from.face % lanes))
    return false;
  Contact c(Contact::spring, 3 * source + corner);
  c.fragment = fragment;
  c.target = nearest.target;
  const Contact* const old = before(c);
  if (!old && !may_begin)
    return false;
  const Facet& y = facet(nearest.target);
  ContactMotion motion;
  motion.depth = depth;
  motion.normal = nearest.at.inside || depth < 1e-9 * to.height ? y.normal : (nearest.place - spring) / depth;
  const Corners x = corners_of(model_, state_, from.nodes);
  const geom::Triangle &n = from.nodes, &m = to.nodes;
  const geom::Vec3 turn_from = velocity_of(state_, n[1]) - velocity_of(state_, n[0]),
                   turn_to = velocity_of(state_, m[1]) - velocity_of(state_, m[0]);
  motion.turned =
      0.5 * work_.step *
      (spin(x[1] - x[0], turn_from, motion.normal) + spin(y.x[1] - y.x[0], turn_to, motion.normal));
  const Law& law = law_between(from.block, to.block);
  finish(c, old, motion, spring_arms(model_, state_, from, corner, to, nearest.at.weights),
         spring_law(*law.joint, law.tan_friction, from, to), from, to);
  return true;
}

double Evaluation::turning_acceleration(const ContactArms& arms, int source_block, int target_block,
                                        double force) const {
  const auto of = [&](int block, const int* nodes, const double* weights, int count) {
    if (work_.last_displacement[block] == 0)
      return 0.; // held: it does not turn round
    const Block& b = model_.blocks[block];
    if (b.rigid >= 0) {
      const RigidBody& body = model_.rigid[b.rigid];
      const std::array<double, 3>& c = state_.rigid[b.rigid].centroid;
      geom::Vec3 arm(-c[0], -c[1], -c[2]);
      for (int i = 0; i < count; ++i)
        arm += weights[i] * place_of(model_, state_, nodes[i]);
      return work_.block_forces[block] / body.mass +
             force * (rigid_inverse_mass(body, arm.norm()) - 1 / body.mass);
    }
    double local = 0; // 1/kg
    for (int i = 0; i < count; ++i)
      local += weights[i] * weights[i] / model_.node_mass[nodes[i]];
    const double mass = b.mass.volume * model_.bodies[b.body].material.density;
    return work_.block_forces[block] / mass + force * local;
  };
  return of(source_block, arms.source.data(), arms.on_source.data(), 3) +
         of(target_block, arms.target.data(), arms.normal.data(), 4);
}

void Evaluation::finish(Contact& c, const Contact* old, ContactMotion& motion, const ContactArms& arms,
                        const ContactLaw& law, const ContactTriangle& from, const ContactTriangle& to) {
  const geom::Vec3 velocity = velocity_past(state_, arms);
  motion.slid = work_.step * velocity;
  if (work_.restitution && law.damping_ratio > 0) {
    motion.speed = -velocity.dot(motion.normal);
    motion.turning_speed =
        work_.step * turning_acceleration(arms, from.block, to.block, law.kn * std::max(0.0, motion.depth));
  }
  ContactForce force;
  const bool own = old && key(*old) == key(c);
  if (own && work_.step == 0 && old->target == c.target) {
    c = *old; // nothing moved
  } else {
    c.normal = old ? old->normal : motion.normal;
    if (old) {
      c.shear = old->shear;
      c.damping = old->damping;
    }
    c.reference_penetration = own ? old->reference_penetration : first_reference_penetration(motion);
    if (old && !own)
      force.friction -= take_over(c, *old, law, motion);
    else if (old && old->target != c.target)
      force.friction += target_change_loss(*old, law, motion);
    const ContactLoss loss = advance(c, law, motion);
    force.friction += loss.friction;
    force.damping = loss.damping;
  }
  force.arms = arms;
  force.source_block = from.block;
  force.target_block = to.block;
  force.normal = (law.kn * c.effective_penetration() + c.damping) * c.normal;
  force.shear = c.shear;
  force.stiffness = law.kn * (1 + law.damping_ratio) + law.ks;
  out_.contacts.push_back(c);
  out_.forces.push_back(force);
  // Not what was found so deep: between the fragments of a broken body that still hang together by a corner.
  ContactSums& sums = out_.sums;
  const double pressed = c.effective_penetration(), part = pressed / depth_limit(work_, from, to);
  sums.depth = std::max(sums.depth, pressed);
  sums.depth_over_height = std::max(sums.depth_over_height, pressed / std::min(from.height, to.height));
  if (part > sums.deepest) {
    sums.deepest = part;
    std::tie(sums.deepest_source, sums.deepest_target) = triangles_of(c);
  }
}

} // namespace cdem
