#include "libcdem/contact/evaluation.hpp"

#include "libcdem/contact/acting.hpp"
#include "libcdem/contact/nearest.hpp"
#include "libcdem/contact/search.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Two edges whose directions enclose an angle with a smaller sine are parallel.
constexpr double parallel = 0.05;
// What is nearer than this many times the deepest contact of a row is looked at in every step.
constexpr double reach_over_depth = 1.5;
// Edges deeper than this many times the shallow depth have slid past each other's ends.
constexpr double deepest_edge = 5;

const Contact* find(const std::vector<Contact>& contacts, const Contact& like) {
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), like,
                                      [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return found != contacts.end() && key(*found) == key(like) ? &*found : nullptr;
}

// The angular velocity about `normal` of a line that moves with its ends, rad/s.
double spin(const geom::Vec3& along, const geom::Vec3& relative_velocity, const geom::Vec3& normal) {
  return normal.cross(along).dot(relative_velocity) / along.squaredNorm();
}

double way(const ContactWork& work, int block_a, int block_b) {
  return work.travelled[block_a] + work.travelled[block_b];
}

class Evaluation {
public:
  Evaluation(const Model& model, const State& state, const ContactWork& work)
      : model_(model), surface_(model.surface), state_(state), work_(work) {}

  void springs(ContactRow& row, ContactCandidate* candidates, ContactChunk& out) const {
    if (row.reach > 0 && sleeps(row, surface_.triangles[row.source].block))
      return;
    const std::size_t contacts = out.contacts.size(), forces = out.forces.size();
    const double friction = out.friction;
    const bool all = row.reach == 0;
    row.reach = std::max(row.reach, work_.shallow);
    double deepest = look_at(row, candidates, all, out);
    while (deepest > row.reach) {
      out.contacts.resize(contacts);
      out.forces.resize(forces);
      out.friction = friction;
      row.reach = reach_over_depth * deepest;
      deepest = look_at(row, candidates, true, out);
    }
    row.reach = std::max(work_.shallow, std::min(row.reach, reach_over_depth * deepest));
  }

  void edges(ContactRow& row, ContactCandidate* candidates, ContactChunk& out) const {
    const ContactEdge& e = surface_.edges[row.source];
    const int block = surface_.triangles[e.triangles[0]].block;
    if (sleeps(row, block))
      return;
    const geom::Vec3 a0 = place_of(model_, state_, e.nodes[0]), a1 = place_of(model_, state_, e.nodes[1]);
    row.wake = std::numeric_limits<double>::infinity();
    for (std::int64_t i = row.begin; i < row.end; ++i) {
      ContactCandidate& candidate = candidates[i];
      const ContactEdge& f = surface_.edges[candidate.target];
      const double moved = way(work_, block, surface_.triangles[f.triangles[0]].block);
      if (moved < candidate.wake) {
        row.wake = std::min(row.wake, candidate.wake);
        continue;
      }
      const geom::Vec3 b0 = place_of(model_, state_, f.nodes[0]), b1 = place_of(model_, state_, f.nodes[1]);
      const auto at = geom::nearest_on_segments(a0, a1, b0, b1);
      const geom::Vec3 a = a0 + at.s * (a1 - a0), b = b0 + at.t * (b1 - b0);
      const double distance = (b - a).norm();
      const ContactTriangle &one = surface_.triangles[e.triangles[0]],
                            &other = surface_.triangles[f.triangles[0]];
      const double limit = std::min(deepest_edge * work_.shallow, depth_limit(work_, one, other));
      candidate.wake = moved + std::max(0.0, distance - limit);
      row.wake = std::min(row.wake, candidate.wake);
      if (at.s <= 0 || at.s >= 1 || at.t <= 0 || at.t >= 1 || distance > limit)
        continue;
      const geom::Vec3 along = (a1 - a0).cross(b1 - b0);
      if (along.norm() < parallel * (a1 - a0).norm() * (b1 - b0).norm())
        continue;
      geom::Vec3 normal = along.normalized(); // out of the target f
      if (!in_fan(f, b0, b1, normal))
        normal = -normal;
      if (!in_fan(f, b0, b1, normal) || !in_fan(e, a0, a1, -normal))
        continue;
      const double depth = (b - a).dot(normal);
      if (depth <= 0)
        continue;
      Contact c;
      c.kind = Contact::edge;
      c.source = row.source;
      c.piece = c.target = candidate.target;
      const geom::Vec3 turn_a = velocity_of(state_, e.nodes[1]) - velocity_of(state_, e.nodes[0]),
                       turn_b = velocity_of(state_, f.nodes[1]) - velocity_of(state_, f.nodes[0]);
      ContactMotion motion;
      motion.normal = normal;
      motion.depth = depth;
      motion.turned = 0.5 * work_.step * (spin(a1 - a0, turn_a, normal) + spin(b1 - b0, turn_b, normal));
      finish(c, motion, edge_arms(model_, state_, e, f, at), out);
    }
  }

private:
  bool bonded(int block) const {
    const Bonding& bonding = model_.bodies[model_.blocks[block].body].bonding;
    return bonding.everywhere || bonding.between_regions || !bonding.regions.empty();
  }

  bool sleeps(const ContactRow& row, int block) const {
    return work_.travelled[block] + work_.furthest < row.wake;
  }

  // Returns how deep the deepest is, m.
  double look_at(ContactRow& row, ContactCandidate* candidates, bool all, ContactChunk& out) const {
    double deepest2 = 0;
    const ContactTriangle& source = surface_.triangles[row.source];
    const Corners x = corners_of(model_, state_, source.nodes);
    std::array<geom::Vec3, 3> spring;
    for (int corner = 0; corner < 3; ++corner)
      spring[corner] = weighted(x, spring_weights(corner));
    row.wake = std::numeric_limits<double>::infinity();
    for (std::int64_t i = row.begin; i < row.end;) {
      const int piece = work_.piece[candidates[i].target];
      std::array<Nearest, 3> nearest;
      for (; i < row.end && work_.piece[candidates[i].target] == piece; ++i) {
        ContactCandidate& candidate = candidates[i];
        const ContactTriangle& target = surface_.triangles[candidate.target];
        const double moved = way(work_, source.block, target.block);
        if (!all && moved < candidate.wake) {
          row.wake = std::min(row.wake, candidate.wake);
          continue;
        }
        const Corners y = corners_of(model_, state_, target.nodes);
        const geom::Vec3 normal = unit_normal(y);
        double least2 = std::numeric_limits<double>::infinity();
        for (int corner = 0; corner < 3; ++corner) {
          const Nearest found = nearest_of(candidate.target, spring[corner], y, normal);
          least2 = std::min(least2, found.distance2);
          take_nearer(nearest[corner], found, y, normal, target.height, bonded(target.block));
        }
        candidate.wake = moved + std::max(0.0, std::sqrt(least2) - row.reach);
        row.wake = std::min(row.wake, candidate.wake);
      }
      for (int corner = 0; corner < 3; ++corner) {
        const Nearest& found = nearest[corner];
        if (!found.inside())
          continue;
        // With some asleep, what is further in than a step can have brought it is not inside: nearer ones sleep.
        const double reach =
            row.reach + work_.last_way[source.block] + work_.last_way[surface_.triangles[found.target].block];
        if (!all && found.distance2 > reach * reach)
          continue;
        const double covered = 2 * depth_limit(work_, source, surface_.triangles[found.target]);
        if (found.distance2 > covered * covered)
          continue; // beyond what the search covers: nearer ones may not be in the row
        deepest2 = std::max(deepest2, found.distance2);
        press(row.source, corner, spring[corner], piece, found, out);
      }
    }
    return std::sqrt(deepest2);
  }

  void press(int source, int corner, const geom::Vec3& spring, int piece, const Nearest& nearest,
             ContactChunk& out) const {
    const ContactTriangle &from = surface_.triangles[source], &to = surface_.triangles[nearest.target];
    const double depth = std::sqrt(nearest.distance2);
    // The two sides of a face that has broken and not yet parted are held by its own springs.
    if (from.mate == nearest.target && !handed_over(state_.faces[from.face / lanes], from.face % lanes))
      return;
    const Corners y = corners_of(model_, state_, to.nodes);
    Contact c;
    c.kind = Contact::spring;
    c.source = 3 * source + corner;
    c.piece = piece;
    c.target = nearest.target;
    ContactMotion motion;
    motion.depth = depth;
    motion.normal =
        nearest.at.inside || depth < 1e-9 * to.height ? unit_normal(y) : (nearest.place - spring) / depth;
    const Corners x = corners_of(model_, state_, from.nodes);
    const geom::Triangle &n = from.nodes, &m = to.nodes;
    const geom::Vec3 turn_from = velocity_of(state_, n[1]) - velocity_of(state_, n[0]),
                     turn_to = velocity_of(state_, m[1]) - velocity_of(state_, m[0]);
    motion.turned = 0.5 * work_.step *
                    (spin(x[1] - x[0], turn_from, motion.normal) + spin(y[1] - y[0], turn_to, motion.normal));
    finish(c, motion, spring_arms(model_, state_, from, corner, to, nearest.at.weights), out);
  }

  // The fan of an edge's outward normals: those that have both its faces behind.
  bool in_fan(const ContactEdge& e, const geom::Vec3& x0, const geom::Vec3& x1,
              const geom::Vec3& normal) const {
    const geom::Vec3 along = (x1 - x0).normalized();
    for (const int t : e.triangles) {
      const Corners x = corners_of(model_, state_, surface_.triangles[t].nodes);
      geom::Vec3 into = (x[0] + x[1] + x[2]) / 3 - x0; // the face, from the edge
      into -= into.dot(along) * along;
      if (normal.dot(into) > 0)
        return false;
    }
    return true;
  }

  void finish(Contact& c, ContactMotion& motion, const ContactArms& arms, ContactChunk& out) const {
    motion.slid = work_.step * velocity_past(state_, arms);
    const ContactLaw law = law_of(model_, c);
    const Contact* const before = find(state_.contacts, c);
    if (before && work_.step == 0 && before->target == c.target) {
      c = *before; // nothing moved
    } else {
      if (before) {
        c.normal = before->normal;
        c.shear = before->shear;
        c.start = before->start;
      } else {
        c.normal = motion.normal;
        c.start = start_depth(motion);
      }
      out.friction += advance(c, law, motion);
    }
    ContactForce force;
    force.arms = arms;
    force.normal = c.normal_force * c.normal;
    force.shear = c.shear;
    force.stiffness = law.kn + law.ks;
    out.contacts.push_back(c);
    out.forces.push_back(force);
  }

  const Model& model_;
  const ContactSurface& surface_;
  const State& state_;
  const ContactWork& work_;
};

} // namespace

void evaluate_springs(const Model& model, const State& state, const ContactWork& work, ContactRow& row,
                      ContactCandidate* candidates, ContactChunk& out) {
  Evaluation(model, state, work).springs(row, candidates, out);
}

void evaluate_edges(const Model& model, const State& state, const ContactWork& work, ContactRow& row,
                    ContactCandidate* candidates, ContactChunk& out) {
  Evaluation(model, state, work).edges(row, candidates, out);
}

} // namespace cdem
