#include "libcdem/contact/narrow_phase/edge_lines.hpp"

#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Distance from the ends, over the distance of two edges that are not nearly parallel: beyond it no other edges of their
// chains are as near.
constexpr double reach_of_ends = 2 / parallel_edges;
// Difference over a tet's height: distances that differ by less are equal, as at a node that two edges share.
constexpr double same_distance = 1e-12;
// Distance of a semi-spring from where two edges cross, over how deep they are in each other: further off it does not stand in
// the other block for their sake, unless its wedge is blunter than 125 degrees; then the push is hardly sideways.
constexpr double beside_crossing = 2;
// Sine of the angle up to which the line of an edge is straight at a node, and from which on it goes into a face. At a node
// where it bends by more stands a corner.
constexpr double aslant = 0.1;

} // namespace

EdgeLines::EdgeLines(const Model& model, const State& state, const SurfaceEdges& edges,
                     const EdgesTouched& touched)
    : model_(model), surface_(model.surface), state_(state), edges_(edges), touched_(touched),
      contacts_(std::partition_point(state.contacts.begin(), state.contacts.end(),
                                     [](const Contact& c) { return c.kind == Contact::spring; })) {}

std::optional<EdgeTouch> EdgeLines::active(int e, int f, const NearestOfEdges& here,
                                           const Contact* old) const {
  auto touch = touch_of(model_, state_, edges_.all[e], edges_.all[f], here, old ? &old->normal : nullptr);
  if (!touch || !(touch->depth > 0))
    return std::nullopt;
  const double distance = here.way.norm();
  if (here.nearly_parallel || // each pair of their chains bears its own stretch
      (far_from_ends(e, here.at.s, distance) && far_from_ends(f, here.at.t, distance)))
    return touch;
  const auto passed = [&](int a, int b, double ways) { // as the two would be evaluated themselves
    const auto [source, target] = std::minmax(a, b);
    const NearestOfEdges there = nearest(source, target);
    if (!nearer(source, target, there, e, f, here))
      return false;
    const auto other = touch_of(model_, state_, edges_.all[source], edges_.all[target], there);
    if (!other || ways * other->sense != touch->sense)
      return false;
    // Two that are others on both lines may be near without being passed there.
    return a == e || b == f ||
           (other->depth > 0 && goes_on(source, there.at.s, target) && goes_on(target, there.at.t, source));
  };
  if (!goes_on(e, here.at.s, f) || !goes_on(f, here.at.t, e) || any_of_line(e, [&](int a, double way_of_a) {
        return any_of_line(f, [&](int b, double way_of_b) { return passed(a, b, way_of_a * way_of_b); });
      }))
    return std::nullopt;
  return touch;
}

std::optional<Contact> EdgeLines::left_behind(int e, int f, const geom::Vec3& normal) const {
  std::optional<Contact> most;
  if (contacts_ == state_.contacts.end())
    return most;
  const std::vector<int> targets = line_of(f);
  double most_force = -1; // N
  for (const int from : line_of(e))
    for (const int to : targets) {
      const Contact* const old = contact_of(from, to);
      if (!old)
        continue;
      const auto [source, target] = std::minmax(from, to);
      const double side = from < to ? 1 : -1;
      if (active(source, target, nearest(source, target)) ||
          !takes_over(e, f, normal, from, to, side * old->normal))
        continue;
      const double force = law_of(model_, *old).kn * old->effective_penetration();
      if (force <= most_force)
        continue;
      most_force = force;
      most = *old;
      most->normal *= side;
      most->shear *= side;
    }
  return most;
}

bool EdgeLines::carry_together(int e, int f) const {
  return any_of_line(e, [&](int a, double) {
    return any_of_line(f, [&](int b, double) { return contact_of(a, b) != nullptr; });
  });
}

bool EdgeLines::takes_over(int e, int f, const geom::Vec3& normal, int from, int to,
                           const geom::Vec3& before) const {
  const std::vector<int> targets = line_of(to);
  for (const int a : line_of(from))
    for (const int b : targets) {
      if (a == b || (a == e && b == f) || contact_of(a, b))
        continue;
      // As the two would be evaluated themselves, and their normal as if a were the source.
      const auto [source, target] = std::minmax(a, b);
      const auto other = active(source, target, nearest(source, target));
      const double side = a < b ? 1 : -1;
      if (other && std::pair(-side * other->normal.dot(before), std::minmax({a, b})) <
                       std::pair(-normal.dot(before), std::minmax({e, f})))
        return false;
    }
  return true;
}

bool EdgeLines::at_last_end(int edge, double place) const {
  if (place > drawn_in && place < 1 - drawn_in)
    return false;
  return edges_.beyond[edges_.continues[edge][place < 0.5 ? 0 : 1]].edge < 0;
}

bool EdgeLines::cuts_off_end(int edge, double place, int by, double within) const {
  const auto direction = [&](int of) -> geom::Vec3 {
    const auto& [a, b] = edges_.all[of].nodes;
    return place_of(model_, state_, b) - place_of(model_, state_, a);
  };
  const geom::Vec3 along = direction(edge), across = direction(by).normalized();
  const double from_end = std::min(place, 1 - place);
  if (from_end > drawn_in && from_end * along.norm() > within)
    return false;
  const geom::Vec3 normal = across.cross(along).normalized();
  return !any_next(edge, place < 0.5 ? 0 : 1, [&](int next, double way) {
    return way * across.cross(direction(next).normalized()).dot(normal) > edges_in_line;
  });
}

bool EdgeLines::touched_around(int e, int f) const {
  const auto touched = [&](int edge) {
    if (touched_.edges[edge])
      return true;
    for (const int begin : edges_.ends[edge])
      for (const int* other = &edges_.at_end[begin]; *other >= 0; ++other)
        if (touched_.edges[*other])
          return true;
    return false;
  };
  return contacts_ != state_.contacts.end() && touched(e) && touched(f);
}

int EdgeLines::edge_with(int id) const {
  for (int e = edges_.begin[id / 3]; e < edges_.begin[id / 3 + 1]; ++e)
    if (edges_.all[e].id() == id)
      return e;
  return -1;
}

bool EdgeLines::carries_at(int triangle, int corner, const geom::Vec3& spring, const geom::Vec3& normal,
                           int other_block) const {
  const ContactTriangle& from = surface_.triangles[triangle];
  if (!touched_.blocks[from.block] || !touched_.blocks[other_block])
    return false;
  const int node = surface_.original[from.nodes[corner]];
  const auto block_of = [&](int id) { return surface_.triangles[id / 3].block; };
  const auto direction = [&](int edge) -> geom::Vec3 { // from the node
    const auto& [a, b] = edges_.all[edge].nodes;
    const geom::Vec3 along = (place_of(model_, state_, b) - place_of(model_, state_, a)).normalized();
    return surface_.original[a] == node ? along : geom::Vec3(-along);
  };
  const auto goes_on_and_in = [&](int edge, int end) {
    const geom::Vec3 back = direction(edge);
    return any_next(edge, end, [&](int next, double) {
      const geom::Vec3 on = direction(next);
      return on.cross(back).norm() < aslant && std::abs(back.dot(normal)) > aslant;
    });
  };
  const auto carries = [&](const Contact& c, int own, int other) {
    if (block_of(own) != from.block || block_of(other) != other_block)
      return false;
    const int e = edge_with(own), f = edge_with(other);
    if (e < 0 || f < 0)
      return false;
    const auto& [a, b] = edges_.all[e].nodes;
    const int end = surface_.original[a] == node ? 0 : 1;
    if (surface_.original[end == 0 ? a : b] != node || !goes_on_and_in(e, end))
      return false;
    const NearestOfEdges near = nearest(std::min(e, f), std::max(e, f));
    const double part = e < f ? near.at.s : near.at.t;
    const geom::Vec3 place = (1 - part) * place_of(model_, state_, a) + part * place_of(model_, state_, b);
    return (spring - place).norm() <= beside_crossing * c.depth;
  };
  return std::any_of(contacts_, state_.contacts.end(), [&](const Contact& c) {
    const auto source = static_cast<int>(c.source);
    return c.kind == Contact::edge && c.effective_penetration() > 0 &&
           (carries(c, source, c.target) || carries(c, c.target, source));
  });
}

const Contact* EdgeLines::contact_of(int e, int f) const {
  const ContactEdge &source = edges_.all[std::min(e, f)], &target = edges_.all[std::max(e, f)];
  Contact like(Contact::edge, source.id());
  like.fragment = source.triangles[1];
  like.target = target.id();
  const auto found = std::lower_bound(contacts_, state_.contacts.end(), like,
                                      [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return found != state_.contacts.end() && key(*found) == key(like) ? &*found : nullptr;
}

NearestOfEdges EdgeLines::nearest(int e, int f) const {
  return nearest_of_edges(model_, state_, edges_.all[e], edges_.all[f]);
}

template <typename Does>
bool EdgeLines::any_next(int edge, int end, const Does& does) const {
  for (const EdgeBeyond* next = &edges_.beyond[edges_.continues[edge][end]]; next->edge >= 0; ++next)
    if (does(next->edge, next->direction))
      return true;
  return false;
}

template <typename Does>
bool EdgeLines::any_of_line(int edge, const Does& does) const {
  return does(edge, 1.) || any_next(edge, 0, does) || any_next(edge, 1, does);
}

// The point is within the edge, or at an end where the edge continues in one that touches the other edge as well.
bool EdgeLines::goes_on(int edge, double place, int other) const {
  return (place > 0 && place < 1) || any_next(edge, place < 0.5 ? 0 : 1, [&](int next, double) {
           if (next == other)
             return false;
           const auto [source, target] = std::minmax(next, other);
           const auto touch =
               touch_of(model_, state_, edges_.all[source], edges_.all[target], nearest(source, target));
           return touch && touch->depth > 0;
         });
}

bool EdgeLines::far_from_ends(int edge, double place, double distance) const {
  const auto& [a, b] = edges_.all[edge].nodes;
  return std::min(place, 1 - place) * (place_of(model_, state_, b) - place_of(model_, state_, a)).norm() >
         reach_of_ends * distance;
}

bool EdgeLines::nearer(int e, int f, const NearestOfEdges& here, int than_e, int than_f,
                       const NearestOfEdges& than) const {
  if (e == f)
    return false;
  const double distance = here.way.norm(), other = than.way.norm();
  const int block = surface_.triangles[edges_.all[e].triangles[0]].block;
  const double same = same_distance * surface_.usual_height[block];
  return std::abs(distance - other) > same ? distance < other : std::pair(e, f) < std::pair(than_e, than_f);
}

std::vector<int> EdgeLines::line_of(int edge) const {
  std::vector<int> edges;
  any_of_line(edge, [&](int other, double) {
    edges.push_back(other);
    return false;
  });
  return edges;
}

} // namespace cdem
