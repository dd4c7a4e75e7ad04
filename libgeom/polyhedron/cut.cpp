// Level-set cut of a convex block, Han 2010 eqs 18-20. Vertices get the sign of phi, faces and then edges
// follow from the signs alone, so both parts are closed whatever the rounding; the cut face closes the hole
// that is left.
#include "libgeom/polyhedron/cut.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace geom {
namespace {

using Sign = signed char; // +1 above, 0 on, -1 below the plane

// Bound of the rounding in phi for the coordinates at hand.
double level_rounding(const Polyhedron& p, const Plane& plane) {
  double largest = std::abs(plane.offset);
  for (const Vec3& x : p.vertices)
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  return 4 * std::numeric_limits<double>::epsilon() * largest;
}

bool has(const std::vector<int>& loop, const std::vector<Sign>& sign, Sign wanted) {
  return std::any_of(loop.begin(), loop.end(), [&](int v) { return sign[v] == wanted; });
}

// A plane crosses the rim of a convex face in exactly two points. With a tolerance, or next to edges that run
// almost in the plane, more vertices may count as "on": keep the nearest one of each crossing, give the
// others their side. Every change takes a zero away, so the loop ends.
void make_crossings_single(const Polyhedron& p, const std::vector<double>& phi, std::vector<Sign>& sign) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const PolyhedronFace& face : p.faces) {
      const std::vector<int>& loop = face.loop;
      if (!has(loop, sign, 1) || !has(loop, sign, -1))
        continue;
      const std::size_t n = loop.size();
      std::size_t start = 0;
      while (sign[loop[start]] == 0)
        ++start;
      for (std::size_t i = 0; i < n;) { // i counts from start; loop[start + i] has a side
        const Sign before = sign[loop[(start + i) % n]];
        std::size_t end = i + 1; // first place after the run of zeros
        while (sign[loop[(start + end) % n]] == 0)
          ++end;
        const Sign after = sign[loop[(start + end) % n]];
        if (end > i + 1 && (before == after || end > i + 2)) {
          std::size_t nearest = i + 1;
          for (std::size_t k = i + 1; k < end; ++k)
            if (std::abs(phi[loop[(start + k) % n]]) < std::abs(phi[loop[(start + nearest) % n]]))
              nearest = k;
          for (std::size_t k = i + 1; k < end; ++k)
            if (before == after || k != nearest)
              sign[loop[(start + k) % n]] = k < nearest ? before : after;
          changed = true;
        }
        i = end;
      }
    }
  }
}

Part whole(const Polyhedron& p) {
  Part part{p, {}};
  for (std::size_t f = 0; f < p.faces.size(); ++f)
    part.parent_face.push_back(static_cast<int>(f));
  return part;
}

// The rim left open by the faces, walked the other way round: the loop of the cut face.
std::vector<int> closing_loop(const std::vector<PolyhedronFace>& faces) {
  std::vector<std::array<int, 2>> directed;
  for (const PolyhedronFace& face : faces)
    for (std::size_t i = 0; i < face.loop.size(); ++i)
      directed.push_back({face.loop[i], face.loop[(i + 1) % face.loop.size()]});
  std::sort(directed.begin(), directed.end());
  std::map<int, int> next;
  std::size_t open = 0;
  for (const auto& [a, b] : directed)
    if (!std::binary_search(directed.begin(), directed.end(), std::array<int, 2>{b, a})) {
      next[b] = a;
      ++open;
    }
  std::vector<int> loop;
  if (!next.empty())
    for (int v = next.begin()->first; loop.size() < open; v = next[v]) {
      loop.push_back(v);
      if (next[v] == loop.front())
        break;
    }
  if (loop.size() < 3 || loop.size() != open)
    throw InputError("cut: the plane leaves no single closed loop on the block; the block must be convex");
  return loop;
}

Part closed_part(const std::vector<Vec3>& points, std::vector<PolyhedronFace> faces,
                 std::vector<int> parents) {
  faces.push_back({closing_loop(faces)});
  parents.push_back(cut_face);
  std::vector<int> number(points.size(), -1);
  for (const PolyhedronFace& face : faces)
    for (int v : face.loop)
      number[v] = 0;
  Part part;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (number[v] == 0) {
      number[v] = static_cast<int>(part.shape.vertices.size());
      part.shape.vertices.push_back(points[v]);
    }
  for (PolyhedronFace& face : faces)
    for (int& v : face.loop)
      v = number[v];
  part.shape.faces = std::move(faces);
  part.parent_face = std::move(parents);
  return part;
}

} // namespace

Cut cut(const Polyhedron& p, const Plane& plane, double tolerance) {
  tolerance = std::max(tolerance, level_rounding(p, plane));
  std::vector<double> phi;
  std::vector<Sign> sign;
  for (const Vec3& x : p.vertices) {
    phi.push_back(plane.level(x));
    sign.push_back(static_cast<Sign>(std::abs(phi.back()) <= tolerance ? 0 : phi.back() > 0 ? 1 : -1));
  }
  const bool any_above = std::count(sign.begin(), sign.end(), Sign{1}) > 0;
  const bool any_below = std::count(sign.begin(), sign.end(), Sign{-1}) > 0;
  Cut result;
  if (!any_below) {
    result.above = whole(p);
    return result;
  }
  if (!any_above) {
    result.below = whole(p);
    return result;
  }
  make_crossings_single(p, phi, sign);

  std::vector<Vec3> points = p.vertices;
  std::map<std::array<int, 2>, int> crossing; // crossed edge -> point (eq 20)
  for (const auto& [a, b] : edges(p))
    if (sign[a] * sign[b] < 0) {
      // Always from the upper end, so that blocks that share the edge get the same point to the last bit.
      const int up = sign[a] > 0 ? a : b, down = sign[a] > 0 ? b : a;
      const double share = std::abs(phi[up]) / (std::abs(phi[up]) + std::abs(phi[down]));
      crossing[{a, b}] = static_cast<int>(points.size());
      points.push_back(p.vertices[up] + share * (p.vertices[down] - p.vertices[up]));
    }

  std::vector<PolyhedronFace> faces_above, faces_below;
  std::vector<int> parents_above, parents_below;
  for (std::size_t f = 0; f < p.faces.size(); ++f) {
    const std::vector<int>& loop = p.faces[f].loop;
    PolyhedronFace above, below;
    if (!has(loop, sign, -1)) { // eq 19a
      above = p.faces[f];
    } else if (!has(loop, sign, 1)) { // eq 19b
      below = p.faces[f];
    } else { // eq 19c
      above.cut = below.cut = p.faces[f].cut;
      above.glued = below.glued = p.faces[f].glued;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int a = loop[i], b = loop[(i + 1) % loop.size()];
        if (sign[a] >= 0)
          above.loop.push_back(a);
        if (sign[a] <= 0)
          below.loop.push_back(a);
        if (sign[a] * sign[b] < 0) {
          const int x = crossing.at({std::min(a, b), std::max(a, b)});
          above.loop.push_back(x);
          below.loop.push_back(x);
        }
      }
    }
    if (!above.loop.empty()) {
      faces_above.push_back(std::move(above));
      parents_above.push_back(static_cast<int>(f));
    }
    if (!below.loop.empty()) {
      faces_below.push_back(std::move(below));
      parents_below.push_back(static_cast<int>(f));
    }
  }
  result.above = closed_part(points, std::move(faces_above), std::move(parents_above));
  result.below = closed_part(points, std::move(faces_below), std::move(parents_below));
  return result;
}

double clear_shift(std::vector<double> levels, double clearance, double rounding) {
  std::sort(levels.begin(), levels.end());
  double best = std::numeric_limits<double>::infinity();
  const auto offer = [&](double shift) {
    if (std::abs(shift) < std::abs(best))
      best = shift;
  };
  // Levels that agree to rounding are one group; the plane may run through a group that stands alone, or in a
  // gap.
  double previous_top = -std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first < levels.size();) {
    std::size_t last = first;
    while (last + 1 < levels.size() && levels[last + 1] - levels[first] <= rounding)
      ++last;
    const double bottom = levels[first], top = levels[last];
    const double next = last + 1 < levels.size() ? levels[last + 1] : std::numeric_limits<double>::infinity();
    if (bottom - previous_top >= 2 * clearance)
      offer(std::clamp(0.0, previous_top + clearance, bottom - clearance));
    if (bottom - previous_top >= clearance && next - top >= clearance)
      offer(top - rounding <= 0 && 0 <= bottom + rounding ? 0 : 0.5 * (bottom + top));
    previous_top = top;
    first = last + 1;
  }
  offer(std::max(0.0, previous_top + clearance));
  return best;
}

Plane shifted_clear_of_vertices(const Polyhedron& p, const Plane& plane, double clearance) {
  std::vector<double> levels;
  for (const Vec3& x : p.vertices)
    levels.push_back(plane.level(x));
  const double shift = clear_shift(std::move(levels), clearance, 0.5 * level_rounding(p, plane));
  return {plane.normal, plane.offset + shift};
}

} // namespace geom
