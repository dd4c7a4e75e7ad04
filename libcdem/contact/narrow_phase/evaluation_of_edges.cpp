// Semi-edges that act: their motion and law, and what they take over from others.
#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/narrow_phase/evaluation.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Where tips pass each other sideways an overlap begins with its full force, and the spring that stores as much has no bound.
// There it is at most so much stiffer than a crossing: it begins without force.
constexpr double most_share = 10;

// Two edges as they stand now.
struct EdgePair {
  const ContactEdge &e, &f;
  geom::Vec3 a0, a1, b0, b1, a, b; // m: their ends, and the ways from the first to the second
  double la, lb, sine;             // m, and of the angle between them
  double blocks_turn; // rad/m, by which two rigid blocks turn past each other at most; infinite: they deform

  EdgePair(const Model& model, const State& state, const ContactEdge& one, const ContactEdge& other,
           double turn)
      : e(one), f(other), a0(place_of(model, state, e.nodes[0])), a1(place_of(model, state, e.nodes[1])),
        b0(place_of(model, state, f.nodes[0])), b1(place_of(model, state, f.nodes[1])), a(a1 - a0),
        b(b1 - b0), la(a.norm()), lb(b.norm()), sine(a.cross(b).norm() / (la * lb)), blocks_turn(turn) {}
};

// The functions below tell how far, m, two edges may go, both together, before something becomes of them that is not now.

// Their nearest places stay at the last end of one of their lines. They move by some times that over the sine between the lines.
double at_last_end_until(const EdgePair& pair, const NearestOfEdges& nearest, bool e_ends, bool f_ends) {
  const auto left = [&](bool ends, double place, double length) {
    return ends && !nearest.nearly_parallel
               ? (drawn_in - std::min(place, 1 - place)) * length * pair.sine / 16
               : 0.;
  };
  return std::max({0., left(e_ends, nearest.at.s, pair.la), left(f_ends, nearest.at.t, pair.lb)});
}

// They stay nearly parallel, or not so.
double same_rules_until(const EdgePair& pair) {
  return 0.5 * std::abs(pair.sine - parallel_edges) / std::min(2 / pair.la + 2 / pair.lb, pair.blocks_turn);
}

// m/s, of its faster end.
double speed_of(const State& state, const ContactEdge& edge) {
  return std::max(velocity_of(state, edge.nodes[0]).norm(), velocity_of(state, edge.nodes[1]).norm());
}

// They do not touch: either normal lies outside a fan (the Gauss map), or it tells that they are apart. Along a common normal of
// two lines any two places of them are as far from each other.
double apart_until(const Model& model, const State& state, const EdgePair& pair, const geom::Vec3& way) {
  const double la = pair.la, lb = pair.lb, sine = pair.sine;
  if (sine < parallel_edges)
    return 0;
  const geom::Vec3 across = pair.a.cross(pair.b) / (sine * la * lb);
  // An edge turns by at most twice the way of its ends over its length, its faces by what that and the way of their
  // centroids make of it, and the common normal by what both edges make of it over the sine; all of it taken twice. Seen from
  // one of two rigid blocks all of the other turns alike.
  const double turns = 2 / la + 2 / lb; // 1/m
  std::array<double, 2> until{0, 0};    // of the normal along and against `across`
  for (const bool of_f : {false, true}) {
    const ContactEdge& edge = of_f ? pair.f : pair.e;
    const geom::Vec3 &x0 = of_f ? pair.b0 : pair.a0, &x1 = of_f ? pair.b1 : pair.a1;
    const auto into = into_faces(model, state, edge, x0, x1);
    for (int i = 0; i < 2; ++i) {
      const Corners x = corners_of(model, state, model.surface.triangles[edge.triangles[i]].nodes);
      const double arm = ((x[0] + x[1] + x[2]) / 3 - x0).norm(), height = into[i].norm();
      const double rate = std::min(4 * turns / sine + 4 * (1 + 2 * arm / (of_f ? lb : la)) / height,
                                   (4 / sine + 2) * pair.blocks_turn);
      for (int sign = 0; sign < 2; ++sign) { // n lies in the fan of f, -n in that of e
        const double outward = (of_f == (sign == 0) ? 1 : -1) * across.dot(into[i]) / height;
        until[sign] = std::max(until[sign], (outward - fan_slack) / rate);
      }
    }
  }
  // How far they are apart changes by what they move, and by what their normal turns over the way between them; the latter
  // alone is taken twice.
  constexpr double rounding = 1 - 1e-6;
  const double turns_least = std::min(turns, pair.blocks_turn), along = way.dot(across),
               rate_along = 1 + 4 * way.norm() * turns_least / sine;
  double& other_side = until[along > 0 ? 1 : 0]; // of the normal along which they are apart
  other_side = std::max(other_side, rounding * std::abs(along) / rate_along);
  return std::min({until[0], until[1], 0.25 * sine / turns_least});
}

// Nearly parallel edges of two rigid blocks have no normal between their fans. It turns by twice what the middle of a fan does,
// over how far the two middles are apart; all of it taken twice.
double without_normal_until(const Model& model, const State& state, const EdgePair& pair) {
  if (std::isinf(pair.blocks_turn))
    return 0;
  const auto into_e = into_faces(model, state, pair.e, pair.a0, pair.a1),
             into_f = into_faces(model, state, pair.f, pair.b0, pair.b1);
  const geom::Vec3 way = way_between_fans(into_e, into_f, pair.a.normalized());
  return std::max(0.0, (clear_of_faces - falls_away(into_e, into_f, way.normalized())) /
                           ((4 / way.norm() + 2) * pair.blocks_turn));
}

// Edges along each other that meet tip on tip in this step stop each other. One that slides along a face and over the edge at
// its end passes a step: the two do not meet before they reach as deep into each other as semi-springs stand in. Edges that
// lie on each other in the undeformed model belong to blocks in rows, which are not to press on each other across an edge:
// they do not meet before they are as far apart as that.
bool may_begin_along(const Model& model, const ContactEdge& e, const ContactEdge& f,
                     const NearestOfEdges& nearest, double moved_in_step) {
  const std::vector<ContactTriangle>& t = model.surface.triangles;
  const auto& x = model.node_position;
  const geom::Vec3 &a0 = x[e.nodes[0]], &a1 = x[e.nodes[1]], &b0 = x[f.nodes[0]], &b1 = x[f.nodes[1]];
  const auto at = geom::nearest_on_segments(a0, a1, b0, b1);
  const double stand_in = drawn_in * std::min(t[e.triangles[0]].height, t[f.triangles[0]].height),
               distance = nearest.way.norm();
  if ((b0 + at.t * (b1 - b0) - a0 - at.s * (a1 - a0)).norm() <= stand_in)
    return distance > stand_in;
  return distance <= 1.5 * moved_in_step ||
         (nearest.stretch && nearest.way.dot(nearest.stretch->normal) > stand_in);
}

} // namespace

void Evaluation::edges(ContactRow& row, ContactCandidate* candidates) {
  const ContactEdge& e = work_.edges.all[row.source];
  const ContactTriangle& from = surface_.triangles[e.triangles[0]];
  const bool touched = work_.edges_touched.blocks[row.source_block] && work_.edges_touched.blocks[row.block];
  const double moved = this->moved(row), from_here = this->from(row);
  const bool skips = !work_.options.looks_at_all;
  const double blocks_turn =
      row.pair >= 0 ? work_.rigid_pairs.all[row.pair].turns : std::numeric_limits<double>::infinity();
  if (skips && moved < row.recheck_distance && !(row.hindered && touched))
    return;
  row.hindered = false;
  go_to(e.id());
  float recheck_distance = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
    ContactCandidate& candidate = candidates[i];
    const auto target = static_cast<int>(candidate.target);
    const bool hindered = candidate.springs != 0;
    if (skips && moved < candidate.recheck_distance &&
        !(hindered && touched && lines_.touched_around(row.source, target))) {
      recheck_distance = std::min(recheck_distance, candidate.recheck_distance);
      row.hindered = row.hindered || hindered;
      continue;
    }
    const ContactEdge& f = work_.edges.all[target];
    const ContactTriangle& to = surface_.triangles[f.triangles[0]];
    const NearestOfEdges nearest = nearest_of_edges(model_, state_, e, f);
    const double distance = nearest.way.norm(), limit = edge_depth(work_.sizes, from, to);
    const double apart = distance - std::max(limit, static_cast<double>(row.reach));
    candidate.recheck_distance = rounded_down(from_here + std::max(0.0, apart));
    candidate.springs = 0;
    // At the last end of a line contacts go on but do not begin.
    const bool e_ends = lines_.at_last_end(row.source, nearest.at.s),
               f_ends = lines_.at_last_end(target, nearest.at.t);
    bool may_begin = distance <= limit && !e_ends && !f_ends;
    if (apart <= 0) {
      const EdgePair pair(model_, state_, e, f, blocks_turn);
      if (may_begin && pair.sine < edges_in_line) {
        may_begin = may_begin_along(model_, e, f, nearest,
                                    work_.step * (speed_of(state_, e) + speed_of(state_, f))) &&
                    !slid_over(e, f, nearest);
      } else if (may_begin) {
        // Where the way between them leads out of one of the two bodies, an end that is nearer than the way is long may have a
        // face that parts them.
        const double within = leads_into_both(model_, state_, e, f, nearest.way) ? 0 : distance;
        may_begin = !lines_.cuts_off_end(row.source, nearest.at.s, target, within) &&
                    !lines_.cuts_off_end(target, nearest.at.t, row.source, within);
      }
      const double by_angle = nearest.nearly_parallel ? without_normal_until(model_, state_, pair)
                                                      : apart_until(model_, state_, pair, nearest.way),
                   last_end = at_last_end_until(pair, nearest, e_ends, f_ends);
      candidate.recheck_distance =
          rounded_down(from_here + std::min(same_rules_until(pair), std::max(by_angle, last_end)));
      candidate.springs = last_end > by_angle ? 1 : 0;
    }
    const Contact* const old = touched ? lines_.contact_of(row.source, target) : nullptr;
    if (old)
      candidate.recheck_distance = rounded_down(from_here);
    recheck_distance = std::min(recheck_distance, candidate.recheck_distance);
    row.hindered = row.hindered || candidate.springs != 0;
    if (!may_begin && !(touched && lines_.touched_around(row.source, target)))
      continue;
    if (const auto touch = lines_.active(row.source, target, nearest, old))
      add_contact(row.source, target, nearest, *touch, may_begin);
  }
  row.recheck_distance = recheck_distance;
}

// Edges of faces that lie on each other, deeper than their motion along the normal: they slid there along a face.
bool Evaluation::slid_over(const ContactEdge& e, const ContactEdge& f, const NearestOfEdges& nearest) {
  const geom::Vec3 slid = work_.step * velocity_past(state_, edge_arms(model_, state_, e, f, nearest));
  return std::any_of(begin(e.triangles), end(e.triangles), [&](int one) {
    return std::any_of(begin(f.triangles), end(f.triangles), [&](int other) {
      const geom::Vec3 normal = facet(one).normal;
      const double depth = std::abs(nearest.way.dot(normal));
      return are_flat(one, other) && depth > 1.5 * std::abs(slid.dot(normal)) && !is_step(one, other, depth);
    });
  });
}

// With l along the one edge and r from the crossing to an end of the other one, that end is y = (r x l) . n from it. The normal n turns with
// both edges, and where they cross moves with it, by their distance times that turn: hence the moment. Its arm may be long beside the
// tetrahedra of bodies that deform, so they do without.
Evaluation::OnFace Evaluation::near_end(int source, int target, const NearestOfEdges& nearest,
                                        const EdgeTouch& touch, ContactMotion& motion) const {
  OnFace on;
  on.crosses = true;
  const auto along = [&](int edge) -> geom::Vec3 {
    const auto [begin, end] = work_.edges.all[edge].nodes;
    return place_of(model_, state_, end) - place_of(model_, state_, begin);
  };
  const geom::Vec3 a = along(source), b = along(target);
  const auto look_at = [&](int edge, double from, double to, const geom::Vec3& own, const geom::Vec3& other,
                           double of_source) {
    if (!lines_.at_last_end(edge, to))
      return;
    const geom::Vec3 r = (to - from) * own, l = other.normalized(), off = l.cross(touch.normal);
    const double distance = r.dot(off), side = std::copysign(1.0, distance);
    if (std::abs(distance) >= on.to_end)
      return;
    on.to_end = std::abs(distance);
    on.off_end = of_source * side * off;
    const geom::Vec3 turns = of_source * l.cross(nearest.way);
    motion.end_moment = side * (of_source * r.dot(l) * touch.normal -
                                touch.sense / a.cross(b).norm() * a.cross(b.cross(turns)));
  };
  for (const double end : {0., 1.}) {
    look_at(source, nearest.at.s, end, a, b, 1);
    look_at(target, nearest.at.t, end, b, a, -1);
  }
  return on;
}

void Evaluation::add_contact(int source, int target, const NearestOfEdges& nearest, const EdgeTouch& touch,
                             bool may_begin) {
  const ContactEdge &e = work_.edges.all[source], &f = work_.edges.all[target];
  const ContactTriangle &from = surface_.triangles[e.triangles[0]], &to = surface_.triangles[f.triangles[0]];
  Contact c(Contact::edge, e.id());
  c.fragment = e.triangles[1];
  c.target = f.id();
  c.beside = f.triangles[1];
  const auto spin_of = [&](const ContactEdge& edge) {
    const auto [begin, end] = edge.nodes;
    return spin(place_of(model_, state_, end) - place_of(model_, state_, begin),
                velocity_of(state_, end) - velocity_of(state_, begin), touch.normal);
  };
  ContactMotion motion;
  motion.normal = touch.normal;
  motion.depth = touch.depth;
  const double spin_e = spin_of(e), spin_f = spin_of(f);
  motion.turned = 0.5 * work_.step * (spin_e + spin_f);
  motion.spin_past = spin_e - spin_f;
  const Law& law = law_between(e.triangles, f.triangles);
  const Contact* old = before(c);
  std::optional<Contact> beyond;
  const ContactLaw own = edge_law(model_, *law.joint, law.tan_friction, e.triangles, f.triangles);
  const auto mean_area = [&](const ContactEdge& edge) {
    return 0.5 * (surface_.triangles[edge.triangles[0]].area + surface_.triangles[edge.triangles[1]].area);
  };
  const double of = edge_area(mean_area(e), mean_area(f));
  const ContactArms arms = edge_arms(model_, state_, e, f, nearest);
  const auto on_faces = [&](const Contact* before) { // where a face of each lies on the other
    const geom::Vec3 a0 = place_of(model_, state_, e.nodes[0]), a1 = place_of(model_, state_, e.nodes[1]);
    for (const int one : e.triangles)
      for (const int other : f.triangles)
        if (are_flat(one, other)) {
          const auto from_end = [&](int edge, double at) {
            return std::min(lines_.at_last_end(edge, 0) ? at : 1, lines_.at_last_end(edge, 1) ? 1 - at : 1);
          };
          const double part =
              part_at_end(std::min(from_end(source, nearest.at.s), from_end(target, nearest.at.t)));
          OnFace on = on_face(work_.faces.of_triangle[one], work_.faces.of_triangle[other],
                              a0 + nearest.at.s * (a1 - a0), of * part, before, false);
          if (!before && on.area > 0 && !work_.any_depth_begins && !is_step(one, other, nearest.way.norm())) {
            const geom::Vec3 slid = work_.step * velocity_past(state_, arms);
            const auto at =
                geom::nearest_on_segments(a0 - slid, a1 - slid, place_of(model_, state_, f.nodes[0]),
                                          place_of(model_, state_, f.nodes[1]));
            on.slid_on = lines_.at_last_end(source, at.s) || lines_.at_last_end(target, at.t);
          }
          return on;
        }
    return both_rigid(model_, from.block, to.block) ? near_end(source, target, nearest, touch, motion)
                                                    : OnFace{};
  };
  OnFace on;
  if (const auto& stretch = nearest.stretch) {
    motion.lever = stretch->lever;
    motion.along_stretch = old && old->area > 0;
    if (!old && !may_begin && !lines_.carry_together(source, target))
      return;
    c.area = old && old->area > 0 ? old->area : stretch->measure * of;
    c.stiffness =
        std::min(most_share, c.area / of * stretch->share) * own.kn; // of the stretch that they have now
  } else if (old) {
    on = on_faces(old);
    set_stiffness(c, old, own, of, on.area);
  } else {
    on = on_faces(nullptr);
    set_stiffness(c, nullptr, own, of, on.area);
    beyond = lines_.left_behind(source, target, touch.normal);
    old = beyond ? &*beyond : nullptr;
    if (!old && !may_begin)
      return;
  }
  finish(c, old, motion, arms, own, from, to, on);
}

double Evaluation::take_over(Contact& c, const Contact& old, const ContactLaw& law,
                             const ContactMotion& motion) const {
  const ContactLaw before = law_of(model_, old);
  const double depth = std::max(0.0, motion.depth + motion.slid.dot(motion.normal)), // before the step
      pressed = std::min(depth, old.effective_penetration() * std::sqrt(before.kn / law.kn));
  c.depth = depth;
  c.reference_penetration = depth - pressed;
  c.damping = std::min(c.damping, part_damped(c, law) * law.kn * pressed);
  c.felt_force *= std::sqrt(law.kn / before.kn);
  c.usual_force *= std::sqrt(law.kn / before.kn);
  c.at_rest *= std::sqrt(before.kn / law.kn);
  c.peak *= std::sqrt(before.kn / law.kn);
  if (before.ks > 0)
    c.shear *= std::sqrt(law.ks / before.ks);
  // contact_forces counts the old contact as ended; what it gave back in the step this one gives.
  const geom::Vec3 slid = work_.step * velocity_past(state_, arms_of(model_, state_, old));
  const double given_back = energy(old, before) - end_loss(old, before, slid);
  return energy(c, law) - given_back;
}

} // namespace cdem
