#include "libgeom/mesh/sound_surface.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <map>

namespace geom {
namespace {

using DirectedEdge = std::array<int, 2>;

// Least height, m: twice the area over the longest edge.
double height(const std::array<Vec3, 3>& x) {
  const double longest = std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
  return longest > 0 ? (x[1] - x[0]).cross(x[2] - x[0]).norm() / longest : 0;
}

// Edges that no neighbour runs through the other way, with the triangle that each belongs to.
std::map<DirectedEdge, std::size_t> open_directed_edges(const Surface& surface) {
  std::map<DirectedEdge, std::size_t> owner;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      owner.emplace(DirectedEdge{surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]}, t);
  std::map<DirectedEdge, std::size_t> open;
  for (const auto& [edge, triangle] : owner)
    if (owner.count({edge[1], edge[0]}) == 0)
      open.emplace(edge, triangle);
  return open;
}

Box grown_box(const Vec3& a, const Vec3& b, double by) {
  Box box;
  box.extend((a.cwiseMin(b).array() - by).matrix());
  box.extend((a.cwiseMax(b).array() + by).matrix());
  return box;
}

// Where x lies on the inside of the edge: from 0 to 1; negative where it does not lie on it.
double place_on(const Vec3& a, const Vec3& b, const Vec3& x, double tolerance) {
  const Vec3 edge = b - a;
  const double part = (x - a).dot(edge) / edge.squaredNorm(), length = edge.norm();
  if (!(part * length > tolerance && (1 - part) * length > tolerance))
    return -1;
  return (a + part * edge - x).norm() <= tolerance ? part : -1;
}

// Splits one open edge of each triangle that has corners of others on it. Returns how many corners it took in.
std::size_t split_once(Surface& surface, double tolerance) {
  const auto open = open_directed_edges(surface);
  std::vector<DirectedEdge> edges;
  std::vector<Box> boxes;
  for (const auto& [edge, triangle] : open) {
    edges.push_back(edge);
    boxes.push_back(grown_box(surface.points[edge[0]], surface.points[edge[1]], tolerance));
  }
  std::map<DirectedEdge, std::map<double, int>> on; // by edge: corners by their place on it
  const auto look = [&](const DirectedEdge& edge, const DirectedEdge& other) {
    for (const int corner : other)
      if (corner != edge[0] && corner != edge[1])
        if (const double part =
                place_on(surface.points[edge[0]], surface.points[edge[1]], surface.points[corner], tolerance);
            part > 0)
          on[edge].emplace(part, corner);
  };
  for (const auto& [i, j] : touching_pairs(boxes)) {
    look(edges[i], edges[j]);
    look(edges[j], edges[i]);
  }
  std::size_t taken = 0;
  std::vector<char> done(surface.triangles.size(), 0);
  for (const auto& [edge, corners] : on) {
    const std::size_t triangle = open.at(edge);
    if (done[triangle])
      continue;
    done[triangle] = 1;
    const Triangle t = surface.triangles[triangle];
    const int apex = t[0] + t[1] + t[2] - edge[0] - edge[1];
    int from = edge[0];
    bool first = true;
    const auto add = [&](int to) {
      const Triangle part{from, to, apex};
      if (first)
        surface.triangles[triangle] = part;
      else
        surface.triangles.push_back(part);
      first = false;
      from = to;
    };
    for (const auto& [part, corner] : corners)
      if (corner != apex) {
        add(corner);
        ++taken;
      }
    add(edge[1]);
  }
  return taken;
}

// Whether the segment passes through the triangle with both ends off its plane.
bool pierces(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t, double tolerance) {
  Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double size = normal.norm();
  if (!(size > 0))
    return false;
  normal /= size;
  const double above = normal.dot(a - t[0]), below = normal.dot(b - t[0]);
  if (!(std::abs(above) > tolerance && std::abs(below) > tolerance && (above > 0) != (below > 0)))
    return false;
  const Vec3 x = a + above / (above - below) * (b - a);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 edge = t[(i + 1) % 3] - t[i];
    if (normal.dot(edge.cross(x - t[i])) < -1e-12 * size)
      return false;
  }
  return true;
}

} // namespace

Mended mend(Surface& surface, double tolerance) {
  Mended mended;
  const auto needle = [&](const Triangle& t) {
    return height({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]}) <= tolerance;
  };
  const auto first = std::remove_if(surface.triangles.begin(), surface.triangles.end(), needle);
  mended.needles = static_cast<std::size_t>(surface.triangles.end() - first);
  surface.triangles.erase(first, surface.triangles.end());
  constexpr int most_rounds = 8; // a triangle has three edges, and a part of it may have corners on it again
  for (int round = 0; round < most_rounds; ++round) {
    const std::size_t taken = split_once(surface, tolerance);
    mended.corners += taken;
    if (taken == 0)
      break;
  }
  return mended;
}

std::string mended_text(const Mended& mended) {
  const auto some = [](std::size_t n, const char* one, const char* many) {
    return std::to_string(n) + (n == 1 ? one : many);
  };
  std::string text;
  if (mended.needles > 0)
    text = some(mended.needles, " triangle without area", " triangles without area");
  if (mended.corners > 0)
    text += (text.empty() ? "" : ", ") + some(mended.corners, " corner", " corners") + " on edges of others";
  return text;
}

void require_uncrossed(const Surface& surface, const std::string& field, double tolerance) {
  std::vector<Box> boxes(surface.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (const Vec3& x : surface.corners(t))
      boxes[t].extend(x);
  const auto crosses = [&](int i, int j) {
    const Triangle &edges = surface.triangles[i], &other = surface.triangles[j];
    const auto has = [&](int corner) { return std::find(other.begin(), other.end(), corner) != other.end(); };
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = edges[k], b = edges[(k + 1) % 3];
      if (!has(a) && !has(b) && pierces(surface.points[a], surface.points[b], surface.corners(j), tolerance))
        return true;
    }
    return false;
  };
  for (const auto& [i, j] : touching_pairs(boxes))
    if (crosses(i, j) || crosses(j, i)) {
      const auto x = surface.corners(i);
      throw InputError(field + ": must not cross itself: a triangle passes through another near " +
                       place_text((x[0] + x[1] + x[2]) / 3));
    }
}

} // namespace geom
