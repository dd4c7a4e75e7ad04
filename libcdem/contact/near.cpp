#include "libcdem/contact/near.hpp"

#include "libcdem/contact/acting.hpp"
#include "libcdem/contact/nearest.hpp"
#include "libcdem/contact/search.hpp"

#include <algorithm>
#include <tuple>

namespace cdem {
namespace {

// Of one source what it may meet of one piece: pairs [begin, end).
void add_near(const Model& model, const State& state, const ContactWork& work, const Cover& cover,
              const Pairs& pairs, std::size_t begin, std::size_t end,
              std::vector<std::array<double, 3>>& distance, std::vector<Near>& out) {
  const ContactSurface& s = model.surface;
  const int source = pairs[begin].first;
  const ContactTriangle& from = s.triangles[source];
  const int block = s.triangles[pairs[begin].second].block;
  const Corners x = corners_of(model, state, from.nodes);
  const double skins = work.skin[from.block] + work.skin[block];
  std::array<geom::Vec3, 3> spring;
  for (int corner = 0; corner < 3; ++corner)
    spring[corner] = weighted(x, spring_weights(corner));
  const bool bonded = has_bonds(model, block);
  std::array<Nearest, 3> nearest;
  distance.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const ContactTriangle& to = s.triangles[pairs[i].second];
    const Corners y = corners_of(model, state, to.nodes);
    const geom::Vec3 normal = unit_normal(y);
    auto& each = distance.emplace_back();
    for (int corner = 0; corner < 3; ++corner) {
      const Nearest found = nearest_of(pairs[i].second, spring[corner], y, normal);
      each[corner] = std::sqrt(found.distance2);
      take_nearer(nearest[corner], found, y, normal, to.height, bonded);
    }
  }
  // Where a surface has holes, as those of pieces that hang together by a corner, what is outside may be inside beyond an
  // edge.
  const double outside = skins + (work.broken[block] ? work.shallow : 0);
  std::array<double, 3> need{};
  for (int corner = 0; corner < 3; ++corner) {
    const Nearest& found = nearest[corner];
    const ContactTriangle& to = s.triangles[found.target];
    const double d = std::sqrt(found.distance2);
    const double deepest = std::min(2 * depth_limit(work, from, to), cover(from) + cover(to));
    if (d <= (found.inside() ? deepest + skins : outside))
      need[corner] = d + 2 * skins;
    else
      need[corner] = -1;
  }
  for (std::size_t i = begin; i < end; ++i) {
    const int target = pairs[i].second;
    // Places that count as one with the nearest.
    const double one_place = (bonded ? bond_gives : same_place_at_least) * s.triangles[target].height;
    std::uint32_t springs = 0;
    for (int corner = 0; corner < 3; ++corner)
      if (need[corner] >= 0 && distance[i - begin][corner] <= (1 + 2 * same_place) * need[corner] + one_place)
        springs |= 1u << corner;
    if (springs == 0)
      continue;
    Near near;
    near.source = source;
    near.target = static_cast<std::uint32_t>(target) & last_contact_triangle;
    near.springs = springs & 7u;
    out.push_back(near);
  }
}

// An edge where it is now, and how far it and its faces may turn before the next search.
struct Bar {
  geom::Vec3 x0, x1, along; // m; unit
  std::array<geom::Vec3, 2> into;
  std::array<double, 2> into_turns{}; // rad
  double turns = 0, skin = 0;         // rad, m
};

Bar bar_of(const Model& model, const State& state, const ContactWork& work, const ContactEdge& e) {
  Bar bar;
  bar.x0 = place_of(model, state, e.nodes[0]);
  bar.x1 = place_of(model, state, e.nodes[1]);
  const double length = (bar.x1 - bar.x0).norm();
  bar.along = (bar.x1 - bar.x0) / length;
  bar.into = into_faces(model, state, e, bar.x0, bar.x1);
  bar.skin = work.skin[model.surface.triangles[e.triangles[0]].block];
  bar.turns = 4 * bar.skin / length; // twice what its ends can make of it
  for (int i = 0; i < 2; ++i) {
    const Corners x = corners_of(model, state, model.surface.triangles[e.triangles[i]].nodes);
    const double arm = ((x[0] + x[1] + x[2]) / 3 - bar.x0).norm();
    bar.into_turns[i] = 2 * (2 * bar.skin + arm * bar.turns) / bar.into[i].norm();
  }
  return bar;
}

bool may_hold(const Bar& bar, const geom::Vec3& normal, double turns) {
  for (int i = 0; i < 2; ++i)
    if (normal.dot(bar.into[i]) > (turns + bar.into_turns[i]) * bar.into[i].norm())
      return false;
  return true;
}

bool may_touch(const Bar& a, const Bar& b, double depth) {
  const geom::Vec3 across = a.along.cross(b.along);
  const double sine = across.norm(), turns = a.turns + b.turns;
  if (sine + turns < parallel_edges)
    return false;
  const auto at = geom::nearest_on_segments(a.x0, a.x1, b.x0, b.x1);
  const double distance = (a.x0 + at.s * (a.x1 - a.x0) - b.x0 - at.t * (b.x1 - b.x0)).norm();
  if (distance > depth + a.skin + b.skin)
    return false;
  if (sine < 4 * turns)
    return true; // their common normal may be anything
  const geom::Vec3 normal = across / sine;
  const double normal_turns = 2 * turns / (sine - turns);
  return (may_hold(b, normal, normal_turns) && may_hold(a, -normal, normal_turns)) ||
         (may_hold(b, -normal, normal_turns) && may_hold(a, normal, normal_turns));
}

} // namespace

double edge_depth(const ContactWork& work, const ContactTriangle& source, const ContactTriangle& target) {
  return std::min(edge_depth(work), depth_limit(work, source, target));
}

std::vector<Near> near_springs(const Model& model, const State& state, const ContactWork& work,
                               const Cover& cover, Pairs& pairs) {
  const auto order = [&](const std::pair<int, int>& p) {
    return std::tuple(p.first, work.piece[p.second], p.second);
  };
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  std::vector<Near> out;
  std::vector<std::array<double, 3>> distance;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const int piece = work.piece[pairs[begin].second];
    while (end < pairs.size() && pairs[end].first == pairs[begin].first &&
           work.piece[pairs[end].second] == piece)
      ++end;
    add_near(model, state, work, cover, pairs, begin, end, distance, out);
  }
  return out;
}

std::vector<Near> near_edges(const Model& model, const State& state, const ContactWork& work,
                             const Pairs& pairs) {
  const ContactSurface& s = model.surface;
  std::vector<Near> out;
  const auto box = [&](int edge, double around) {
    const ContactEdge& e = work.edges[edge];
    const geom::Vec3 x0 = place_of(model, state, e.nodes[0]), x1 = place_of(model, state, e.nodes[1]);
    return box_of({x0, x1, x1}, around);
  };
  for (const auto& [a, b] : pairs) {
    const ContactTriangle &one = s.triangles[a], &other = s.triangles[b];
    const double depth = edge_depth(work, one, other),
                 around = depth + work.skin[one.block] + work.skin[other.block];
    for (int e = work.edge_begin[a]; e < work.edge_begin[a + 1]; ++e)
      for (int f = work.edge_begin[b]; f < work.edge_begin[b + 1]; ++f)
        if (!apart(box(e, around), box(f, 0)) &&
            may_touch(bar_of(model, state, work, work.edges[e]), bar_of(model, state, work, work.edges[f]),
                      depth)) {
          Near near;
          near.source = std::min(e, f);
          near.target = static_cast<std::uint32_t>(std::max(e, f)) & last_contact_triangle;
          near.springs = 0;
          out.push_back(near);
        }
  }
  return out;
}

} // namespace cdem
