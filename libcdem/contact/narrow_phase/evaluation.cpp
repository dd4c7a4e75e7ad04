#include "libcdem/contact/narrow_phase/evaluation.hpp"

#include "libcdem/contact/broad_phase/contact_fragments.hpp"
#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/narrow_phase/rows_asleep.hpp"
#include "libcdem/contact/response/contact_point.hpp"
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
      lines_(model, state, work.edges, work.edges_touched), old_(state.contacts.end()) {
  facet_of_.fill(-1);
}

void Evaluation::springs(ContactRow& row, ContactCandidate* candidates) {
  go_to(3 * row.source);
  const std::size_t contacts = out_.contacts.size(), forces = out_.forces.size();
  const ContactSums sums = out_.sums;
  const bool all = row.reach == 0 || row.several_blocks || work_.options.looks_at_all;
  const auto shallow = static_cast<float>(
      std::min(work_.sizes.shallow[surface_.triangles[row.source].block], work_.sizes.shallow[row.block]));
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

const Evaluation::Law& Evaluation::law_between(const TrianglesOfSide& from, const TrianglesOfSide& to) {
  const int block_a = surface_.triangles[from[0]].block, block_b = surface_.triangles[to[0]].block;
  const std::array between = surface_.pairs.empty()
                                 ? std::array{model_.blocks[block_a].body, model_.blocks[block_b].body, -1}
                                 : std::array{block_a, block_b, law_left_between(model_, from, to)};
  Law& law = laws_[static_cast<std::size_t>(between[0] + between[1]) % laws_.size()];
  if (law.between != between) {
    const Joint* const joint = contact_joint(model_, from, to);
    law = {between, joint, std::min(geom::portable::tan(joint->friction_angle), work_.options.most_friction)};
  }
  return law;
}

double Evaluation::moved(const ContactRow& row) const {
  return row.pair >= 0 ? work_.rigid_pairs.all[row.pair].moved : travelled(model_, work_, row);
}

double Evaluation::from(const ContactRow& row) const {
  return row.pair >= 0 ? work_.rigid_pairs.all[row.pair].from : moved(row);
}

double Evaluation::moved_in_step(const ContactRow& row) const {
  double of_targets = 0;
  each_target_block(model_, work_, row, [&](int block) {
    of_targets = std::max(of_targets, work_.travel.last_displacement[block]);
  });
  return work_.travel.last_displacement[row.source_block] + of_targets;
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

Contact spring_contact(int source, int corner, int fragment) {
  Contact c(Contact::spring, 3 * source + corner);
  c.fragment = fragment;
  return c;
}

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

Nearest Evaluation::nearest_on(int target, const geom::Vec3& spring, double gives) {
  const Facet& y = facet(target);
  Nearest nearest;
  take_nearer(nearest, nearest_of(target, spring, y.x, y.normal), y.x, y.normal,
              surface_.triangles[target].height, gives);
  return nearest;
}

// A plane that has all of them on its outer side is enough. The one that parted them best is tried first.
bool Evaluation::stand_outside(ContactRow& row, const Springs& spring) {
  const bool of_pair = row.pair >= 0;
  const int* planes = nullptr;
  int count = 0;
  if (of_pair) {
    planes = work_.rigid_pairs.planes[row.block].data();
    count = static_cast<int>(work_.rigid_pairs.planes[row.block].size());
  } else if (row.fragment >= 0 && !of_several_tets(work_.fragments, row.fragment)) {
    planes = work_.fragments.triangles_of_tet[row.fragment].data();
    count = 4;
  }
  if (count == 0 || work_.options.looks_at_all)
    return false;
  const auto outside = [&](int plane) { // m, of each
    const Facet& y = facet(planes[plane]);
    return geom::Vec3((spring[0] - y.x[0]).dot(y.normal), (spring[1] - y.x[0]).dot(y.normal),
                      (spring[2] - y.x[0]).dot(y.normal));
  };
  geom::Vec3 most = outside(row.plane);
  double least = most.minCoeff();
  const double height = surface_.triangles[planes[row.plane]].height;
  if (least < shallow_ratio * height) {
    double best = least;
    for (int plane = 0; plane < count; ++plane) {
      const geom::Vec3 here = outside(plane);
      most = most.cwiseMax(here);
      if (here.minCoeff() > best) {
        best = here.minCoeff();
        row.plane = static_cast<std::uint8_t>(plane);
      }
    }
    least = most.minCoeff();
  }
  const double slack = of_pair ? slack_of(model_, work_, row.block) : 4 * same_place_at_least * height,
               until = least - slack - 16 * same_place * least;
  if (until <= 0)
    return false;
  row.known_target = {-1, -1, -1};
  row.known_until.fill(rounded_down(from(row) + until));
  row.recheck_distance = row.known_until[0];
  return true;
}

void Evaluation::find_nearest(ContactRow& row, ContactCandidate* candidates, bool all, const Springs& spring,
                              std::array<Nearest, 3>& nearest) {
  const double moved = this->moved(row), from = this->from(row);
  const double gives = gives_of(model_, work_, row.block, row.fragment);
  const bool cracked = held_by_bonds(work_.fragments, row.fragment);
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
      take_nearer(nearest[corner], found, y.x, y.normal, triangle.height, gives);
    }
    // It sleeps no longer than it is too far off to count as one place with what a contact may begin at.
    const double one_place = gives * triangle.height + 4 * same_place * row.reach;
    candidate.recheck_distance =
        rounded_down(from + std::max(0.0, std::sqrt(least2) - row.reach - one_place));
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
    const double one_place = gives * d.tet + 4 * same_place * least;
    double until = 0;
    row.known_target[corner] = nearest[corner].inside() ? d.target : -1;
    // What is outside gets in through the surface; that of a crack is not closed.
    if (row.known_target[corner] < 0)
      until = least - 4 * one_place - (cracked ? row.reach : 0);
    else if (d.target == nearest[corner].target)
      until = 0.5 * (d.second * (1 - 4 * same_place) - least - one_place);
    row.known_until[corner] = rounded_down(from + std::max(0.0, until));
  }
}

// What is deep and was no contact before has come there by no motion, as at the mouth of a crack. Steps with some asleep do
// not see it: it would begin where a search happens to be.
double Evaluation::begins_at(int source, int target, double shallow) const {
  const auto has_broken = [&](int triangle) {
    const int block = surface_.triangles[triangle].block;
    return work_.sizes.freed[block] != 0 || work_.fragments.broken[block] != 0;
  };
  const bool any_depth = work_.any_depth_begins ||
                         (work_.any_depth_of_broken && (has_broken(source) || has_broken(target))) ||
                         work_.fragments.changed[source] != 0 || work_.fragments.changed[target] != 0;
  return any_depth ? std::numeric_limits<double>::infinity() : shallow;
}

double Evaluation::narrow_phase(ContactRow& row, ContactCandidate* candidates, bool all) {
  const ContactTriangle& source = surface_.triangles[row.source];
  const Corners x = corners_of(model_, state_, source.nodes);
  Springs spring;
  for (int corner = 0; corner < 3; ++corner)
    spring[corner] = weighted(x, spring_weights(corner));
  const double moved = this->moved(row), ways = moved_in_step(row);
  std::array<Nearest, 3> nearest;
  float sleeps = std::numeric_limits<float>::infinity();
  const bool looks = all || moved >= *std::min_element(row.known_until.begin(), row.known_until.end());
  if (!looks) {
    const double gives = gives_of(model_, work_, row.block, row.fragment);
    row.recheck_distance = 0;
    for (int corner = 0; corner < 3; ++corner)
      if (row.known_target[corner] >= 0)
        nearest[corner] = nearest_on(row.known_target[corner], spring[corner], gives);
  } else {
    if (stand_outside(row, spring))
      return 0;
    nearest = {};
    find_nearest(row, candidates, all, spring, nearest);
  }
  double deepest2 = 0;
  // A row sleeps as long as none of its springs has a contact, can begin one, or may have another target.
  const auto sleep = [&](int corner) { sleeps = std::min(sleeps, row.known_until[corner]); };
  for (int corner = 0; corner < 3; ++corner) {
    if (row.known_target[corner] < 0) {
      sleep(corner);
      if (!nearest[corner].inside())
        continue;
    } else if (!nearest[corner].inside()) {
      sleeps = 0;
      continue;
    }
    const std::optional<Nearest> pressed = pressed_by(row.source, spring[corner], nearest[corner]);
    if (!pressed) {
      sleeps = 0;
      continue;
    }
    const Nearest& found = *pressed;
    const double shallow = std::min(work_.sizes.shallow[source.block],
                                    work_.sizes.shallow[surface_.triangles[found.target].block]);
    const auto sleep_without_contact = [&] { // too deep to begin, by the motion of the step too
      sleeps = std::min(
          sleeps, rounded_down(from(row) + std::max(0.0, 0.5 * (std::sqrt(found.distance2) - shallow))));
      sleep(corner);
    };
    const double reach = row.reach + ways;
    const double covered = 2 * depth_limit(work_.sizes, source, surface_.triangles[found.target]);
    const int fragment = work_.fragments.of_triangle[found.target];
    // With some asleep, what is further in than a step can have brought it is not inside: nearer ones sleep. But a contact
    // goes on at any depth, as one that leaves a part of the fragment where another part overlaps it. All are looked at then.
    const bool too_deep = !all && found.distance2 > reach * reach;
    if (too_deep && before(spring_contact(row.source, corner, fragment)))
      deepest2 = std::max(deepest2, found.distance2);
    // Beyond what the search covers nearer ones may not be in the row.
    if (too_deep || found.distance2 > covered * covered) {
      sleep_without_contact();
      continue;
    }
    if (add_contact(row.source, corner, spring[corner], fragment, found,
                    begins_at(row.source, found.target, shallow))) {
      deepest2 = std::max(deepest2, found.distance2);
      sleeps = 0;
    } else {
      sleep_without_contact();
    }
  }
  row.recheck_distance = std::max(row.recheck_distance, sleeps);
  return std::sqrt(deepest2);
}

// Blocks that lie side by side never end in exactly one plane. Where a face slides over such a step, the springs of its
// outline come to lie nearest to the side of the next block, which would stop them. They wait until they are nearest to the
// face that they slide on.
bool Evaluation::at_a_step(const ContactTriangle& from, const geom::Vec3& outward, const geom::Vec3& spring,
                           const geom::Vec3& normal, int target) const {
  for (const int beyond : work_.edges.triangle_beyond[target]) {
    if (beyond < 0)
      continue;
    const ContactTriangle& face = surface_.triangles[beyond];
    const Corners y = corners_of(model_, state_, face.nodes);
    const geom::Vec3 over = unit_normal(y);
    const double depth = (y[0] - spring).dot(over);
    if (depth >= 0 && depth <= drawn_in * std::min(from.height, face.height) &&
        outward.dot(over) < outward.dot(normal))
      return true;
  }
  return false;
}

// It keeps the stiffness with which it began: under another triangle of the target its energy would jump.
void Evaluation::set_stiffness(Contact& c, const Contact* old, const ContactLaw& law, double of,
                               double on) const {
  c.area = old ? old->area : 0;
  c.stiffness = old && old->stiffness > 0 ? old->stiffness : law.kn;
  if (on > 0 && !old)
    c.stiffness *= on / of;
  if (on > 0 && c.area == 0)
    c.area = old ? of : on;
}

bool Evaluation::add_contact(int source, int corner, const geom::Vec3& spring, int fragment,
                             const Nearest& nearest, double begins) {
  const ContactTriangle &from = surface_.triangles[source], &to = surface_.triangles[nearest.target];
  const double depth = std::sqrt(nearest.distance2);
  Contact c = spring_contact(source, corner, fragment);
  c.target = nearest.target;
  const Contact* const old = before(c);
  const ContactArms arms = spring_arms(model_, state_, from, corner, to, nearest.at.weights);
  const double of = spring_area(from.area, to.area);
  const int f = work_.faces.of_triangle[source], g = work_.faces.of_triangle[nearest.target];
  OnFace on;
  if (f >= 0 && g >= 0) {
    on = on_face(f, g, spring, spring_area(from.area, work_.faces.all[g].usual_area), old, true);
    if (!old && on.area > 0 && !work_.any_depth_begins && !is_step(source, nearest.target, depth))
      on.slid_on = !cover(f, g).covers(spring - work_.step * velocity_past(state_, arms));
  }
  if (!old && !on.slid_on && depth > begins &&
      depth > begins + work_.step * velocity_past(state_, arms).norm())
    return false;
  const Facet& y = facet(nearest.target);
  ContactMotion motion;
  motion.depth = depth;
  motion.normal = nearest.at.inside || depth < 1e-9 * to.height ? y.normal : (nearest.place - spring) / depth;
  const Corners x = corners_of(model_, state_, from.nodes);
  if (!old && !on.slid_on &&
      (lines_.carries_at(source, corner, spring, motion.normal, to.block) ||
       at_a_step(from, unit_normal(x), spring, motion.normal, nearest.target)))
    return false;
  const auto velocities = [&](const geom::Triangle& nodes) -> Corners {
    return {velocity_of(state_, nodes[0]), velocity_of(state_, nodes[1]), velocity_of(state_, nodes[2])};
  };
  motion.turned =
      0.5 * work_.step *
      (spin(x, velocities(from.nodes), motion.normal) + spin(y.x, velocities(to.nodes), motion.normal));
  const Law& between = law_between({source, source}, {nearest.target, nearest.target});
  const ContactLaw law = spring_law(model_, *between.joint, between.tan_friction, from, to);
  set_stiffness(c, old, law, of, on.area);
  finish(c, old, motion, arms, law, from, to, on);
  return true;
}

} // namespace cdem
