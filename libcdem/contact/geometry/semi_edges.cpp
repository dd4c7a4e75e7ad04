#include "libcdem/contact/geometry/semi_edges.hpp"

#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace cdem {
namespace {

// A triangle at an edge of the mesh, which runs from its corner to the next.
struct Side {
  int triangle = 0, corner = 0;
  bool inner = false;
  bool begins = false; // the wedge lies at larger angles
  double angle = 0;    // rad, about the edge from its smaller original node to the other
};

bool is_outside(const State& state, const ContactTriangle& t) {
  return t.face < 0 || (state.faces[t.face / lanes].told[t.face % lanes] & ToldOfFace::gone) != 0;
}

// The original nodes of a side, as its triangle runs along it.
std::pair<int, int> nodes_of_side(const ContactSurface& s, int side) {
  const geom::Triangle& nodes = s.triangles[side / 3].nodes;
  return {s.original[nodes[side % 3]], s.original[nodes[(side + 1) % 3]]};
}

// Without what is outside and found.
EdgesOfBroken sides_of(const Model& model, int block) {
  const ContactSurface& s = model.surface;
  const int first = 3 * s.block_begin[block], last = 3 * s.block_begin[block + 1];
  EdgesOfBroken of;
  of.block = block;
  // By the smaller node first: its sides are few.
  std::vector<int> begin(s.original.size() + 2, 0); // shifted by one until they are filled
  const auto edge = [&](int side) {
    const auto [from, to] = nodes_of_side(s, side);
    return std::pair(std::min(from, to), std::max(from, to));
  };
  for (int side = first; side < last; ++side)
    ++begin[edge(side).first + 2];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::pair<int, int>> sides(last - first); // larger node, side
  for (int side = first; side < last; ++side) {
    const auto [node, other] = edge(side);
    sides[begin[node + 1]++] = {other, side};
  }
  of.sides.reserve(sides.size());
  for (std::size_t node = 0; node < s.original.size(); ++node) {
    const auto here = sides.begin() + begin[node], end = sides.begin() + begin[node + 1];
    std::sort(here, end);
    for (auto side = here; side != end; ++side) {
      if (side == here || side->first != (side - 1)->first)
        of.begin.push_back(static_cast<int>(of.sides.size()));
      of.sides.push_back(side->second);
    }
  }
  of.begin.push_back(static_cast<int>(of.sides.size()));
  return of;
}

void set_angles(const Model& model, Side* begin, Side* end) {
  const auto place = [&](const Side& side, int corner) -> const geom::Vec3& {
    return model.node_position[model.surface.triangles[side.triangle].nodes[(side.corner + corner) % 3]];
  };
  const geom::Vec3 &one = place(*begin, 0), &other = place(*begin, 1);
  const geom::Vec3 x = begin->begins ? other : one;
  const geom::Vec3 along = ((begin->begins ? one : other) - x).normalized();
  const geom::Vec3 zero = along.cross(place(*begin, 2) - x).cross(along).normalized(),
                   right = along.cross(zero);
  for (Side* side = begin; side != end; ++side) {
    const geom::Vec3 arm = place(*side, 2) - x;
    side->angle = geom::portable::atan2(arm.dot(right), arm.dot(zero));
  }
  std::sort(begin, end,
            [](const Side& p, const Side& q) { // the two sides of a broken face stand at one angle
              return std::tie(p.angle, p.begins, p.triangle) < std::tie(q.angle, q.begins, q.triangle);
            });
}

// Adds the wedges between the sides of one edge of the mesh; some of the sides are inner.
void add_wedges(const Model& model, Side* begin, Side* end, std::vector<ContactEdge>& edges) {
  set_angles(model, begin, end);
  const auto n = end - begin;
  for (std::ptrdiff_t i = 0; i < n; ++i)
    if (begin[i].begins == begin[(i + 1) % n].begins)
      return; // not the sides of wedges
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const Side &from = begin[i], &to = begin[(i + 1) % n];
    if (!from.begins)
      continue;
    const double wedge = to.angle - from.angle + (i + 1 == n ? 2 * M_PI : 0);
    if (wedge < M_PI - least_edge_turn)
      edges.push_back(edge_between(model.surface, from.triangle, from.corner, to.triangle, to.corner));
  }
}

// Looks at those edges of the mesh at which other triangles are outside than before.
void find_edges(const Model& model, const State& state, EdgesOfBroken& of) {
  const ContactSurface& s = model.surface;
  const int first = s.block_begin[of.block];
  std::vector<char> outside, changed;
  for (int t = first; t < s.block_begin[of.block + 1]; ++t) {
    outside.push_back(static_cast<char>(is_outside(state, s.triangles[t])));
    changed.push_back(static_cast<char>(of.outside.empty() || of.outside[t - first] != outside.back()));
  }
  const std::vector<ContactEdge> before = std::move(of.found);
  const std::vector<int> before_begin = std::move(of.found_begin);
  of.found.clear();
  of.found_begin.assign(1, 0);
  std::vector<Side> sides;
  for (std::size_t edge = 0; edge + 1 < of.begin.size(); ++edge) {
    const auto begin = of.sides.begin() + of.begin[edge], end = of.sides.begin() + of.begin[edge + 1];
    if (std::none_of(begin, end, [&](int side) { return changed[side / 3 - first] != 0; })) {
      of.found.insert(of.found.end(), before.begin() + before_begin[edge],
                      before.begin() + before_begin[edge + 1]);
    } else {
      sides.clear();
      for (auto side = begin; side != end; ++side)
        if (outside[*side / 3 - first]) {
          const auto [from, to] = nodes_of_side(s, *side);
          // A face stands at larger angles of what is behind it when it runs to the larger node: its normal points there.
          sides.push_back({*side / 3, *side % 3, s.triangles[*side / 3].face >= 0, from > to, 0});
        }
      if (std::any_of(sides.begin(), sides.end(), [](const Side& side) { return side.inner; }))
        add_wedges(model, sides.data(), sides.data() + sides.size(), of.found);
      else if (sides.size() == 2)
        if (const auto convex =
                convex_edge(model, sides[0].triangle, sides[0].corner, sides[1].triangle, sides[1].corner))
          of.found.push_back(*convex);
    }
    of.found_begin.push_back(static_cast<int>(of.found.size()));
  }
  of.outside = std::move(outside);
}

// By their ids, of which each occurs once.
void add_in_order(const ContactSurface& s, const EdgesOfBroken& of, std::vector<ContactEdge>& edges) {
  const int first = 3 * s.block_begin[of.block];
  std::vector<int> at(3 * s.block_begin[of.block + 1] - first, -1);
  for (std::size_t i = 0; i < of.found.size(); ++i)
    at[of.found[i].id() - first] = static_cast<int>(i);
  for (const int i : at)
    if (i >= 0)
      edges.push_back(of.found[i]);
}

// Cosine of the angle, undeformed, up to which an edge continues the line of another one.
constexpr double line_cosine = 0.7;

// One end of an edge of a fragment.
struct End {
  int fragment = 0, edge = 0, end = 0;
};

void find_ends(const Model& model, const ContactFragments& fragments, SurfaceEdges& edges) {
  const std::vector<int>& original = model.surface.original;
  std::vector<int> begin(original.size() + 2, 0); // by original node; shifted by one until they are filled
  for (const ContactEdge& edge : edges.all)
    for (const int node : edge.nodes)
      ++begin[original[node] + 2];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<End> ends(2 * edges.all.size());
  for (int e = 0; e < static_cast<int>(edges.all.size()); ++e)
    for (int end = 0; end < 2; ++end)
      ends[begin[original[edges.all[e].nodes[end]] + 1]++] = {
          fragments.of_triangle[edges.all[e].triangles[0]], e, end};
  edges.ends.resize(edges.all.size());
  edges.at_end.reserve(3 * edges.all.size());
  for (std::size_t node = 0; node < original.size(); ++node) {
    const auto first = ends.begin() + begin[node], last = ends.begin() + begin[node + 1];
    std::stable_sort(first, last, [](const End& x, const End& y) { return x.fragment < y.fragment; });
    auto place = static_cast<int>(edges.at_end.size());
    for (auto end = first; end != last; ++end) {
      edges.ends[end->edge][end->end] = place;
      edges.at_end.push_back(end->edge);
      if (end + 1 == last || (end + 1)->fragment != end->fragment) {
        edges.at_end.push_back(-1);
        place = static_cast<int>(edges.at_end.size());
      }
    }
  }
}

// In which edges the lines of all edges continue.
void find_lines(const Model& model, SurfaceEdges& edges) {
  std::vector<geom::Vec3> direction; // of each edge, from its first node to the other
  for (const ContactEdge& edge : edges.all)
    direction.push_back(
        (model.node_position[edge.nodes[1]] - model.node_position[edge.nodes[0]]).normalized());
  const std::vector<int>& original = model.surface.original;
  edges.continues.resize(edges.all.size());
  for (int e = 0; e < static_cast<int>(edges.all.size()); ++e)
    for (int end = 0; end < 2; ++end) {
      edges.continues[e][end] = static_cast<int>(edges.beyond.size());
      for (const int* other = &edges.at_end[edges.ends[e][end]]; *other >= 0; ++other) {
        const bool begins = original[edges.all[*other].nodes[0]] == original[edges.all[e].nodes[end]],
                   along = begins == (end == 1);
        const double cosine = direction[e].dot(direction[*other]);
        if (*other != e && (along ? cosine : -cosine) > line_cosine)
          edges.beyond.push_back({*other, along ? 1. : -1.});
      }
      edges.beyond.push_back({});
    }
}

void find_triangles_beyond(const ContactSurface& s, SurfaceEdges& edges) {
  edges.triangle_beyond.assign(s.triangles.size(), {-1, -1, -1});
  for (const ContactEdge& e : edges.all) {
    const auto [first, second] = e.triangles;
    edges.triangle_beyond[first][e.corner] = second;
    const geom::Triangle& nodes = s.triangles[second].nodes;
    for (int corner = 0; corner < 3; ++corner) // there it runs the other way
      if (s.original[nodes[corner]] == s.original[e.nodes[1]] &&
          s.original[nodes[(corner + 1) % 3]] == s.original[e.nodes[0]])
        edges.triangle_beyond[second][corner] = first;
  }
}

} // namespace

SurfaceEdges find_semi_edges(const Model& model, const State& state, const ContactFragments& fragments,
                             std::vector<EdgesOfBroken> known) {
  const ContactSurface& s = model.surface;
  SurfaceEdges edges;
  auto at = known.begin();
  std::size_t next = 0;
  for (int b = 0; b + 1 < static_cast<int>(s.block_begin.size()); ++b) {
    const std::size_t first = next;
    while (next < s.edges.size() && s.edges[next].triangles[0] < s.block_begin[b + 1])
      ++next;
    if (!fragments.broken[b]) {
      edges.all.insert(edges.all.end(), s.edges.begin() + static_cast<std::ptrdiff_t>(first),
                       s.edges.begin() + static_cast<std::ptrdiff_t>(next));
      continue;
    }
    while (at != known.end() && at->block < b)
      ++at;
    EdgesOfBroken& of = edges.of_broken.emplace_back(
        at != known.end() && at->block == b ? std::move(*at++) : sides_of(model, b));
    find_edges(model, state, of);
    add_in_order(s, of, edges.all);
  }
  edges.begin.assign(s.triangles.size() + 1, 0);
  for (const ContactEdge& e : edges.all)
    ++edges.begin[e.triangles[0] + 1];
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    edges.begin[t + 1] += edges.begin[t];
  find_triangles_beyond(s, edges);
  find_ends(model, fragments, edges);
  find_lines(model, edges);
  return edges;
}

} // namespace cdem
