// Semi-edges: which of them act, and which go on with what another has stored when an end has been passed.
#include "libcdem/contact/acting.hpp"
#include "libcdem/contact/evaluation.hpp"
#include "libcdem/contact/near.hpp"
#include "libcdem/contact/search.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// An edge goes on in another one that encloses an angle with it of which this is the cosine, or more.
constexpr double goes_on = 0.7;

} // namespace

void Evaluation::edges(ContactRow& row, ContactCandidate* candidates) {
  const ContactEdge& e = work_.edges[row.source];
  const ContactTriangle& from = surface_.triangles[e.triangles[0]];
  if (sleeps(row, from.block))
    return;
  go_to(e.id());
  const double moved = work_.travelled[from.block] + work_.travelled[row.block];
  float wake = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
    ContactCandidate& candidate = candidates[i];
    if (moved < candidate.wake) {
      wake = std::min(wake, candidate.wake);
      continue;
    }
    const ContactEdge& f = work_.edges[candidate.target];
    const ContactTriangle& to = surface_.triangles[f.triangles[0]];
    const NearestOfEdges nearest = nearest_of_edges(model_, state_, e, f);
    const double distance = nearest.way.norm(), limit = edge_depth(work_, from, to);
    candidate.wake =
        rounded_down(moved + std::max(0.0, distance - std::max(limit, static_cast<double>(row.reach))));
    wake = std::min(wake, candidate.wake);
    if (!nearest.within_both())
      continue;
    if (const auto touch = touch_of(model_, state_, e, f, nearest))
      press(row.source, static_cast<int>(candidate.target), nearest, *touch, distance <= limit);
  }
  row.wake = wake;
}

void Evaluation::press(int source, int target, const NearestOfEdges& nearest, const EdgeTouch& touch,
                       bool may_begin) {
  const ContactEdge &e = work_.edges[source], &f = work_.edges[target];
  const ContactTriangle &from = surface_.triangles[e.triangles[0]], &to = surface_.triangles[f.triangles[0]];
  Contact c(Contact::edge, e.id());
  c.piece = e.triangles[1];
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
  motion.turned = 0.5 * work_.step * (spin_of(e) + spin_of(f));
  const Law& law = law_between(from.block, to.block);
  const Contact* old = before(c);
  std::optional<Contact> beyond;
  if (!old) {
    beyond = before_an_end(source, target, touch.normal);
    old = beyond ? &*beyond : nullptr;
    if (!old && (!may_begin || at_last_end(source, nearest.at.s) || at_last_end(target, nearest.at.t)))
      return;
  }
  finish(c, old, motion, edge_arms(model_, state_, e, f, nearest.at),
         edge_law(*law.joint, law.tan_friction, surface_, e.triangles, f.triangles), from, to);
}

std::vector<int> Evaluation::with_those_at_ends(int edge) const {
  std::vector<int> edges{edge};
  for (const int begin : work_.edge_ends[edge])
    for (const int* other = &work_.edges_at[begin]; *other >= 0; ++other)
      if (*other != edge)
        edges.push_back(*other);
  return edges;
}

bool Evaluation::at_last_end(int edge, double place) const {
  if (place > drawn_in && place < 1 - drawn_in)
    return false;
  const int end = place < 0.5 ? 0 : 1;
  const ContactEdge& e = work_.edges[edge];
  const int node = surface_.original[e.nodes[end]];
  const auto direction = [&](int from, int to) {
    return geom::Vec3((place_of(model_, state_, to) - place_of(model_, state_, from)).normalized());
  };
  const geom::Vec3 along = direction(e.nodes[1 - end], e.nodes[end]);
  for (const int* other = &work_.edges_at[work_.edge_ends[edge][end]]; *other >= 0; ++other) {
    const auto& [a, b] = work_.edges[*other].nodes;
    if (*other != edge &&
        along.dot(surface_.original[a] == node ? direction(a, b) : direction(b, a)) > goes_on)
      return false;
  }
  return true;
}

const Contact* Evaluation::contact_of(int e, int f) const {
  const ContactEdge &source = work_.edges[std::min(e, f)], &target = work_.edges[std::max(e, f)];
  Contact like(Contact::edge, source.id());
  like.piece = source.triangles[1];
  like.target = target.id();
  const auto found = std::lower_bound(old_edges_, state_.contacts.end(), like,
                                      [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return found != state_.contacts.end() && key(*found) == key(like) ? &*found : nullptr;
}

std::optional<Contact> Evaluation::before_an_end(int e, int f, const geom::Vec3& normal) const {
  std::optional<Contact> most;
  if (old_edges_ == state_.contacts.end())
    return most;
  const std::vector<int> targets = with_those_at_ends(f);
  double most_force = -1; // N
  for (const int from : with_those_at_ends(e))
    for (const int to : targets) {
      const Contact* const old = contact_of(from, to);
      if (!old || nearest_of_edges(model_, state_, work_.edges[from], work_.edges[to]).within_both())
        continue;
      const double side = from < to ? 1 : -1;
      if (!takes_over(e, f, normal, from, to, side * old->normal))
        continue;
      const double force = law_of(model_, *old).kn * old->pressed();
      if (force <= most_force)
        continue;
      most_force = force;
      most = *old;
      most->normal *= side;
      most->shear *= side;
    }
  return most;
}

bool Evaluation::takes_over(int e, int f, const geom::Vec3& normal, int from, int to,
                            const geom::Vec3& before) const {
  const std::vector<int> targets = with_those_at_ends(to);
  for (const int a : with_those_at_ends(from))
    for (const int b : targets) {
      if (a == b || (a == e && b == f) || contact_of(a, b))
        continue;
      // As the two would be evaluated themselves, and their normal as if a were the source.
      const ContactEdge &source = work_.edges[std::min(a, b)], &target = work_.edges[std::max(a, b)];
      const NearestOfEdges nearest = nearest_of_edges(model_, state_, source, target);
      if (!nearest.within_both())
        continue;
      const auto touch = touch_of(model_, state_, source, target, nearest);
      const double side = a < b ? 1 : -1;
      if (touch && std::pair(-side * touch->normal.dot(before), std::minmax({a, b})) <
                       std::pair(-normal.dot(before), std::minmax({e, f})))
        return false;
    }
  return true;
}

double Evaluation::take_over(Contact& c, const Contact& old, const ContactLaw& law,
                             const ContactMotion& motion) const {
  const ContactLaw before = law_of(model_, old);
  const double depth = std::max(0.0, motion.depth + motion.slid.dot(motion.normal)), // before the step
      pressed = std::min(depth, old.pressed() * std::sqrt(before.kn / law.kn));
  c.start = depth - pressed;
  if (before.ks > 0)
    c.shear *= std::sqrt(law.ks / before.ks);
  return energy(pressed, c.shear.norm(), law);
}

} // namespace cdem
