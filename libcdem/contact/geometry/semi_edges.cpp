#include "libcdem/contact/geometry/semi_edges.hpp"

#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace cdem {
namespace {

// A triangle at an edge of the mesh, which runs from its corner to the next.
struct Side {
  int a = 0, b = 0; // the edge by its original nodes, a < b
  int triangle = 0, corner = 0;
  bool inner = false;
  bool begins = false; // the wedge lies at larger angles
  double angle = 0;    // rad, about the edge from a to b
};

bool is_outside(const State& state, const ContactTriangle& t) {
  return t.face < 0 || (state.faces[t.face / lanes].told[t.face % lanes] & ToldOfFace::gone) != 0;
}

std::vector<Side> sides_of(const Model& model, const State& state, int block) {
  const ContactSurface& s = model.surface;
  std::vector<Side> sides;
  for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t) {
    const ContactTriangle& triangle = s.triangles[t];
    if (!is_outside(state, triangle))
      continue;
    for (int corner = 0; corner < 3; ++corner) {
      const int from = s.original[triangle.nodes[corner]], to = s.original[triangle.nodes[(corner + 1) % 3]];
      // A face stands at larger angles of what is behind it when it runs from a to b: its normal points there.
      sides.push_back({std::min(from, to), std::max(from, to), t, corner, triangle.face >= 0, from > to, 0});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.a, x.b, x.triangle, x.corner) < std::tie(y.a, y.b, y.triangle, y.corner);
  });
  return sides;
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

void add_edges_of_broken(const Model& model, const State& state, int block, std::vector<ContactEdge>& edges) {
  std::vector<Side> sides = sides_of(model, state, block);
  Side* const all_end = sides.data() + sides.size();
  for (Side *begin = sides.data(), *end = begin; begin != all_end; begin = end) {
    end = std::find_if(begin, all_end,
                       [&](const Side& side) { return side.a != begin->a || side.b != begin->b; });
    if (std::any_of(begin, end, [](const Side& side) { return side.inner; }))
      add_wedges(model, begin, end, edges);
    else if (end - begin == 2)
      if (const auto edge =
              convex_edge(model, begin[0].triangle, begin[0].corner, begin[1].triangle, begin[1].corner))
        edges.push_back(*edge);
  }
}

// Cosine of the angle, undeformed, up to which an edge continues the line of another one.
constexpr double line_cosine = 0.7;

// One end of an edge of a fragment.
struct End {
  int fragment = 0, node = 0; // original
  int edge = 0, end = 0;
};

void find_ends(const Model& model, const Movers& movers, SurfaceEdges& edges) {
  std::vector<End> ends;
  ends.reserve(2 * edges.all.size());
  for (int e = 0; e < static_cast<int>(edges.all.size()); ++e)
    for (int end = 0; end < 2; ++end)
      ends.push_back({movers.fragment_of_triangle[edges.all[e].triangles[0]],
                      model.surface.original[edges.all[e].nodes[end]], e, end});
  std::sort(ends.begin(), ends.end(), [](const End& x, const End& y) {
    return std::tie(x.fragment, x.node, x.edge) < std::tie(y.fragment, y.node, y.edge);
  });
  edges.ends.resize(edges.all.size());
  edges.at_end.reserve(3 * edges.all.size());
  int begin = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    edges.ends[ends[i].edge][ends[i].end] = begin;
    edges.at_end.push_back(ends[i].edge);
    if (i + 1 == ends.size() || ends[i + 1].fragment != ends[i].fragment ||
        ends[i + 1].node != ends[i].node) {
      edges.at_end.push_back(-1);
      begin = static_cast<int>(edges.at_end.size());
    }
  }
}

// In which edges the lines of all edges continue.
void find_lines(const Model& model, SurfaceEdges& edges) {
  const auto direction = [&](int from, int to) -> geom::Vec3 {
    return (model.node_position[to] - model.node_position[from]).normalized();
  };
  const std::vector<int>& original = model.surface.original;
  edges.continues.resize(edges.all.size());
  for (int e = 0; e < static_cast<int>(edges.all.size()); ++e)
    for (int end = 0; end < 2; ++end) {
      const std::array<int, 2>& nodes = edges.all[e].nodes;
      const geom::Vec3 along = direction(nodes[1 - end], nodes[end]);
      edges.continues[e][end] = static_cast<int>(edges.beyond.size());
      for (const int* other = &edges.at_end[edges.ends[e][end]]; *other >= 0; ++other) {
        const auto& [a, b] = edges.all[*other].nodes;
        const bool begins = original[a] == original[nodes[end]];
        if (*other != e && along.dot(begins ? direction(a, b) : direction(b, a)) > line_cosine)
          edges.beyond.push_back({*other, begins == (end == 1) ? 1. : -1.});
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

SurfaceEdges find_semi_edges(const Model& model, const State& state, const Movers& movers) {
  const ContactSurface& s = model.surface;
  SurfaceEdges edges;
  std::size_t next = 0;
  for (int b = 0; b + 1 < static_cast<int>(s.block_begin.size()); ++b) {
    const std::size_t first = next;
    while (next < s.edges.size() && s.edges[next].triangles[0] < s.block_begin[b + 1])
      ++next;
    const auto begin = static_cast<std::ptrdiff_t>(edges.all.size());
    if (!movers.broken[b]) {
      edges.all.insert(edges.all.end(), s.edges.begin() + static_cast<std::ptrdiff_t>(first),
                       s.edges.begin() + static_cast<std::ptrdiff_t>(next));
      continue;
    }
    add_edges_of_broken(model, state, b, edges.all);
    std::sort(edges.all.begin() + begin, edges.all.end(),
              [](const ContactEdge& x, const ContactEdge& y) { return x.id() < y.id(); });
  }
  edges.begin.assign(s.triangles.size() + 1, 0);
  for (const ContactEdge& e : edges.all)
    ++edges.begin[e.triangles[0] + 1];
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    edges.begin[t + 1] += edges.begin[t];
  find_triangles_beyond(s, edges);
  find_ends(model, movers, edges);
  find_lines(model, edges);
  return edges;
}

} // namespace cdem
