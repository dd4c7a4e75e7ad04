#include "libcdem/contact/contact_forces.hpp"

#include "libcdem/contact/build_surface.hpp"
#include "libcdem/contact/places.hpp"
#include "libcdem/contact/search.hpp"
#include "libgeom/query/closest.hpp"

#include <cmath>
#include <tuple>

namespace cdem {
namespace {

// Semi-springs stand in from their corners by this part of the way to each of the two others.
constexpr double drawn_in = 0.01;
// Two edges whose directions enclose an angle with a smaller sine are parallel.
constexpr double parallel = 0.05;
// Edges deeper than this many times the shallow depth have slid past each other's ends.
constexpr double deepest_edge = 5;
// Of a distance, and of a tet's height: places on the edges of two triangles that are nearer than that to each other are
// one. Tets that a bond holds together have edges of their own, which part by as much as the bond gives.
constexpr double same_place = 1e-6, bond_gives = 3e-4;

geom::Vec3 spring_weights(int corner) {
  geom::Vec3 w = geom::Vec3::Constant(drawn_in);
  w[corner] = 1 - 2 * drawn_in;
  return w;
}

auto key(const Contact& c) {
  return std::tuple(c.kind, c.source, c.piece);
}

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

// The nearest place of a piece to a spring, so far. Of the triangles that share it the one that the spring stands
// highest over or lowest under is the target; whether the spring is inside their normals tell together, each weighted
// by the angle that its triangle fills there (Baerentzen and Aanaes 2005): one alone may be wrong at a sharp corner or
// the mouth of a crack.
struct Nearest {
  int target = -1;
  double distance2 = 0;
  double height = 0; // of the spring over the target's plane, m: below 0 behind it
  geom::PlaceOnTriangle at;
  geom::Vec3 place = geom::Vec3::Zero();
  geom::Vec3 outward = geom::Vec3::Zero(); // sum of the normals, weighted
  geom::Vec3 from = geom::Vec3::Zero();    // m, the spring from the place

  bool inside() const { return target >= 0 && outward.dot(from) < 0; }
};

// rad, that the triangle fills around a place of it.
double angle_at(const geom::PlaceOnTriangle& at, const Corners& x) {
  for (int i = 0; i < 3; ++i)
    if (at.weights[(i + 1) % 3] == 0 && at.weights[(i + 2) % 3] == 0) {
      const geom::Vec3 a = x[(i + 1) % 3] - x[i], b = x[(i + 2) % 3] - x[i];
      return std::atan2(a.cross(b).norm(), a.dot(b));
    }
  return at.inside ? 2 * M_PI : M_PI;
}

Nearest nearest_of(int target, const geom::Vec3& spring, const Corners& x, const geom::Vec3& normal) {
  Nearest found;
  found.target = target;
  found.at = geom::nearest_on_triangle(spring, x[0], x[1], x[2]);
  found.place = weighted(x, found.at.weights);
  found.from = spring - found.place;
  found.distance2 = found.from.squaredNorm();
  found.height = found.from.dot(normal);
  return found;
}

// size: m, of the tets there.
void take_nearer(Nearest& nearest, Nearest other, const Corners& x, const geom::Vec3& normal, double size) {
  const double reach =
      same_place * std::sqrt(std::max(nearest.distance2, other.distance2)) + bond_gives * size;
  const bool one_place = nearest.target >= 0 && !nearest.at.inside && !other.at.inside &&
                         (other.place - nearest.place).squaredNorm() <= reach * reach;
  if (!one_place && nearest.target >= 0 && other.distance2 >= nearest.distance2)
    return;
  other.outward = angle_at(other.at, x) * normal;
  if (one_place)
    other.outward += nearest.outward;
  if (one_place && std::abs(other.height) <= std::abs(nearest.height))
    nearest.outward = other.outward;
  else
    nearest = other;
}

// Weights of a tet's corners that make up a place, which may lie a little outside.
std::array<double, 4> in_tet(const Model& model, const State& state, const geom::Tet& nodes,
                             const geom::Vec3& place) {
  std::array<geom::Vec3, 4> x;
  for (int i = 0; i < 4; ++i)
    x[i] = place_of(model, state, nodes[i]);
  const geom::Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0], p = place - x[0];
  const double volume = a.dot(b.cross(c));
  const double wa = p.dot(b.cross(c)) / volume, wb = a.dot(p.cross(c)) / volume,
               wc = a.dot(b.cross(p)) / volume;
  return {1 - wa - wb - wc, wa, wb, wc};
}

void set_normal_weight(ContactArms& arms, int node, double weight) {
  for (int i = 0; i < 4; ++i)
    if (arms.target[i] == node)
      arms.normal[i] = weight;
}

ContactArms spring_arms(const Model& model, const State& state, const ContactTriangle& from, int corner,
                        const ContactTriangle& to, const geom::Vec3& nearest) {
  ContactArms arms;
  const geom::Vec3 w = spring_weights(corner);
  arms.source = from.nodes;
  arms.target = model.tets[to.tet];
  arms.on_source = {w[0], w[1], w[2]};
  for (int i = 0; i < 3; ++i)
    set_normal_weight(arms, to.nodes[i], nearest[i]);
  arms.shear = in_tet(model, state, arms.target, weighted(corners_of(model, state, from.nodes), w));
  return arms;
}

ContactArms edge_arms(const Model& model, const State& state, const ContactEdge& e, const ContactEdge& f,
                      const geom::PlacesOnSegments& at) {
  ContactArms arms;
  arms.source = {e.nodes[0], e.nodes[1], e.nodes[0]};
  arms.on_source = {1 - at.s, at.s, 0};
  arms.target = model.tets[model.surface.triangles[f.triangles[0]].tet];
  set_normal_weight(arms, f.nodes[0], 1 - at.t);
  set_normal_weight(arms, f.nodes[1], at.t);
  const geom::Vec3 place =
      (1 - at.s) * place_of(model, state, e.nodes[0]) + at.s * place_of(model, state, e.nodes[1]);
  arms.shear = in_tet(model, state, arms.target, place);
  return arms;
}

ContactArms arms_of(const Model& model, const State& state, const Contact& c) {
  const ContactSurface& s = model.surface;
  if (c.kind == Contact::edge) {
    const ContactEdge &e = s.edges[c.source], &f = s.edges[c.target];
    return edge_arms(
        model, state, e, f,
        geom::nearest_on_segments(place_of(model, state, e.nodes[0]), place_of(model, state, e.nodes[1]),
                                  place_of(model, state, f.nodes[0]), place_of(model, state, f.nodes[1])));
  }
  const ContactTriangle &from = s.triangles[c.source / 3], &to = s.triangles[c.target];
  const geom::Vec3 spring = weighted(corners_of(model, state, from.nodes), spring_weights(c.source % 3));
  const Corners y = corners_of(model, state, to.nodes);
  return spring_arms(model, state, from, c.source % 3, to,
                     geom::nearest_on_triangle(spring, y[0], y[1], y[2]).weights);
}

// m/s, of the source past the target.
geom::Vec3 velocity_past(const State& state, const ContactArms& arms) {
  geom::Vec3 v = geom::Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    v += arms.on_source[i] * velocity_of(state, arms.source[i]);
  for (int i = 0; i < 4; ++i)
    v -= arms.shear[i] * velocity_of(state, arms.target[i]);
  return v;
}

class Evaluation {
public:
  Evaluation(const Model& model, const State& state, const ContactWork& work)
      : model_(model), surface_(model.surface), state_(state), work_(work) {}

  void springs(ContactRow& row, ContactCandidate* candidates, ContactChunk& out) const {
    if (!row.deep && sleeps(row, surface_.triangles[row.source].block))
      return;
    const std::size_t contacts = out.contacts.size(), forces = out.forces.size();
    const double friction = out.friction;
    const bool was_deep = row.deep;
    row.deep = false;
    look_at(row, candidates, was_deep, out);
    if (!row.deep || was_deep)
      return;
    out.contacts.resize(contacts);
    out.forces.resize(forces);
    out.friction = friction;
    look_at(row, candidates, true, out);
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
  bool sleeps(const ContactRow& row, int block) const {
    return work_.travelled[block] + work_.furthest < row.wake;
  }

  void look_at(ContactRow& row, ContactCandidate* candidates, bool all, ContactChunk& out) const {
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
          take_nearer(nearest[corner], found, y, normal, target.height);
        }
        candidate.wake = moved + std::max(0.0, std::sqrt(least2) - work_.shallow);
        row.wake = std::min(row.wake, candidate.wake);
      }
      for (int corner = 0; corner < 3; ++corner) {
        const Nearest& found = nearest[corner];
        if (!found.inside())
          continue;
        // With some asleep, what is further in than a step can have brought it is not inside: nearer ones sleep.
        const double reach = work_.shallow + work_.last_way[source.block] +
                             work_.last_way[surface_.triangles[found.target].block];
        if (!all && found.distance2 > reach * reach)
          continue;
        const double covered = 2 * depth_limit(work_, source, surface_.triangles[found.target]);
        if (found.distance2 > covered * covered)
          continue; // beyond what the search covers: nearer ones may not be in the row
        row.deep = row.deep || found.distance2 > work_.shallow * work_.shallow;
        press(row.source, corner, spring[corner], piece, found, out);
      }
    }
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

std::pair<int, int> triangles_of(const Model& model, const Contact& c) {
  const ContactSurface& s = model.surface;
  return c.kind == Contact::spring
             ? std::pair(c.source / 3, c.target)
             : std::pair(s.edges[c.source].triangles[0], s.edges[c.target].triangles[0]);
}

// What contacts stored that act no more, J: their other side has gone round an edge or off the end of another.
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

ContactLaw law_of(const Model& model, const Contact& c) {
  const ContactSurface& s = model.surface;
  const auto [source, target] = triangles_of(model, c);
  const ContactTriangle &from = s.triangles[source], &to = s.triangles[target];
  const Joint& joint = *contact_joint(model, from.block, to.block);
  const ContactStiffness stiffness = contact_stiffness(joint, from, to);
  // A third of the face for each of its springs; a third of each of its two faces for an edge. Both bodies bring
  // theirs, so each counts half.
  const double area = c.kind == Contact::spring
                          ? from.area / 6
                          : (from.area + s.triangles[s.edges[c.source].triangles[1]].area) / 6;
  return {stiffness.normal * area, stiffness.shear * area, std::tan(joint.friction_angle)};
}

std::pair<int, int> blocks_of(const Model& model, const Contact& c) {
  const auto [source, target] = triangles_of(model, c);
  return {model.surface.triangles[source].block, model.surface.triangles[target].block};
}

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
  std::sort(state.contacts.begin(), state.contacts.end(),
            [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  const Evaluation evaluation(model, state, own);
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
        evaluation.springs(own.rows[kind][r], candidates, out);
      else
        evaluation.edges(own.rows[kind][r], candidates, out);
  });
  std::vector<Contact> now;
  now.reserve(state.contacts.size());
  for (const ContactChunk& chunk : own.chunks) {
    now.insert(now.end(), chunk.contacts.begin(), chunk.contacts.end());
    sums.friction += chunk.friction;
  }
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
