#include "libgeom/assembly/join_thin.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/stop.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace geom {
namespace {

constexpr double same = 1e-7; // of a block's size: vertices, and vertices in planes

Plane plane_of(const Polyhedron& p, int face) {
  return Plane::through(face_centroid(p, face), face_normal(p, face));
}

// For each place of b's loop the vertex of a that lies there, if the loops run against each other over the same points.
std::optional<std::vector<int>> matched(const Polyhedron& a, int face_a, const Polyhedron& b, int face_b,
                                        double tolerance) {
  const std::vector<int>&one = a.faces[face_a].loop, &other = b.faces[face_b].loop;
  if (one.size() != other.size())
    return std::nullopt;
  std::vector<int> partner;
  for (const int v : other) {
    const auto at = std::find_if(one.begin(), one.end(),
                                 [&](int w) { return (a.vertices[w] - b.vertices[v]).norm() <= tolerance; });
    if (at == one.end())
      return std::nullopt;
    partner.push_back(*at);
  }
  return partner;
}

bool below_all(const Polyhedron& shape, const Polyhedron& planes_of, int but, double tolerance) {
  for (int f = 0; f < static_cast<int>(planes_of.faces.size()); ++f) {
    if (f == but)
      continue;
    const Plane plane = plane_of(planes_of, f);
    for (const Vec3& x : shape.vertices)
      if (plane.level(x) > tolerance)
        return false;
  }
  return true;
}

// The loop of two faces with opposite edges u v: that of `a` with the one of `b` in place of the edge.
std::vector<int> spliced(const std::vector<int>& a, const std::vector<int>& b, int u, int v) {
  std::vector<int> loop;
  const auto at = [](const std::vector<int>& l, int vertex) {
    return static_cast<std::size_t>(std::find(l.begin(), l.end(), vertex) - l.begin());
  };
  const std::size_t start = at(a, v);
  for (std::size_t i = 0; i < a.size(); ++i) // from v round to u
    loop.push_back(a[(start + i) % a.size()]);
  const std::size_t next = at(b, u);
  for (std::size_t i = 1; i + 1 < b.size(); ++i) // what lies between u and v in b
    loop.push_back(b[(next + i) % b.size()]);
  return loop;
}

// Takes out vertices that only two faces use: they lie within an edge.
void drop_needless_vertices(Polyhedron& p) {
  std::vector<int> faces(p.vertices.size(), 0), number(p.vertices.size(), -1);
  for (const PolyhedronFace& face : p.faces)
    for (const int v : face.loop)
      ++faces[v];
  std::vector<Vec3> left;
  for (std::size_t v = 0; v < p.vertices.size(); ++v)
    if (faces[v] > 2) {
      number[v] = static_cast<int>(left.size());
      left.push_back(p.vertices[v]);
    }
  for (PolyhedronFace& face : p.faces) {
    std::vector<int> loop;
    for (const int v : face.loop)
      if (number[v] >= 0)
        loop.push_back(number[v]);
    face.loop = std::move(loop);
  }
  p.vertices = std::move(left);
}

struct Joining {
  double area = 0;
  int thin = 0, face = 0, other = 0, other_face = 0;
};

} // namespace

double thickness(const Polyhedron& p) {
  double least = std::numeric_limits<double>::infinity();
  for (int f = 0; f < static_cast<int>(p.faces.size()); ++f) {
    const Plane plane = plane_of(p, f);
    double height = 0;
    for (const Vec3& x : p.vertices)
      height = std::max(height, -plane.level(x));
    least = std::min(least, height);
  }
  return least;
}

std::optional<Polyhedron> united(const Polyhedron& a, int face_a, const Polyhedron& b, int face_b) {
  const double tolerance = same * std::min(bounding_box(a).size().norm(), bounding_box(b).size().norm());
  const auto partner = matched(a, face_a, b, face_b, tolerance);
  if (!partner || !below_all(b, a, face_a, tolerance) || !below_all(a, b, face_b, tolerance))
    return std::nullopt;
  Polyhedron both;
  both.vertices = a.vertices;
  std::vector<int> number(b.vertices.size(), -1);
  for (std::size_t i = 0; i < partner->size(); ++i)
    number[b.faces[face_b].loop[i]] = (*partner)[i];
  for (std::size_t v = 0; v < b.vertices.size(); ++v)
    if (number[v] < 0) {
      number[v] = static_cast<int>(both.vertices.size());
      both.vertices.push_back(b.vertices[v]);
    }
  std::vector<PolyhedronFace> others; // of b, over the common vertices
  for (int f = 0; f < static_cast<int>(b.faces.size()); ++f)
    if (f != face_b) {
      others.push_back(b.faces[f]);
      for (int& v : others.back().loop)
        v = number[v];
    }
  for (int f = 0; f < static_cast<int>(a.faces.size()); ++f) {
    if (f == face_a)
      continue;
    PolyhedronFace face = a.faces[f];
    const Plane plane = plane_of(a, f);
    // A face of b across an edge of the common face, in the same plane.
    for (auto other = others.begin(); other != others.end();) {
      const bool flat = std::all_of(other->loop.begin(), other->loop.end(), [&](int v) {
        return std::abs(plane.level(both.vertices[v])) <= tolerance;
      });
      bool joined = false;
      for (std::size_t i = 0; flat && !joined && i < face.loop.size(); ++i) {
        const int u = face.loop[i], v = face.loop[(i + 1) % face.loop.size()];
        for (std::size_t k = 0; !joined && k < other->loop.size(); ++k)
          if (other->loop[k] == v && other->loop[(k + 1) % other->loop.size()] == u) {
            face.loop = spliced(face.loop, other->loop, u, v);
            joined = true;
          }
      }
      other = joined ? others.erase(other) : std::next(other);
    }
    both.faces.push_back(std::move(face));
  }
  both.faces.insert(both.faces.end(), others.begin(), others.end());
  drop_needless_vertices(both);
  try {
    validate(both);
  } catch (const InputError&) {
    return std::nullopt; // to rounding no longer convex
  }
  return both;
}

JoinedThin join_thin(Assembly assembly, double smallest) {
  if (!(smallest >= 0 && std::isfinite(smallest)))
    throw InputError("smallest", text(smallest), "finite and >= 0 m");
  JoinedThin result;
  std::vector<Polyhedron>& blocks = assembly.blocks;
  std::set<std::string> joints; // names of cuts with faces that are not glued
  for (const Polyhedron& block : blocks)
    for (const PolyhedronFace& face : block.faces)
      if (!face.glued && !face.cut.empty())
        joints.insert(face.cut);
  if (smallest > 0)
    for (bool changed = true; changed;) {
      throw_if_stopped();
      changed = false;
      std::vector<char> thin;
      double size = 0;
      for (const Polyhedron& block : blocks) {
        thin.push_back(thickness(block) < smallest ? 1 : 0);
        size = std::max(size, bounding_box(block).size().norm());
      }
      std::vector<Joining> candidates;
      for (const SharedFace& s : shared_faces(blocks, thin, same * std::min(size, smallest))) {
        // Not across a construction cut: the outline of an excavation stays a plane, and what lies behind it is removed.
        if (blocks[s.block_a].faces[s.face_a].glued && blocks[s.block_b].faces[s.face_b].glued)
          continue;
        const double area =
            std::min(face_area(blocks[s.block_a], s.face_a), face_area(blocks[s.block_b], s.face_b));
        if (thin[s.block_a])
          candidates.push_back({area, s.block_a, s.face_a, s.block_b, s.face_b});
        if (thin[s.block_b])
          candidates.push_back({area, s.block_b, s.face_b, s.block_a, s.face_a});
      }
      std::sort(candidates.begin(), candidates.end(), [](const Joining& x, const Joining& y) {
        return std::tuple(-x.area, x.thin, x.face, x.other) < std::tuple(-y.area, y.thin, y.face, y.other);
      });
      std::vector<char> done(blocks.size(), 0), gone(blocks.size(), 0);
      for (const Joining& c : candidates) {
        if (done[c.thin] || done[c.other])
          continue;
        auto both = united(blocks[c.other], c.other_face, blocks[c.thin], c.face);
        if (!both)
          continue;
        blocks[c.other] = std::move(*both);
        done[c.other] = done[c.thin] = gone[c.thin] = 1;
        ++result.united;
        changed = true;
      }
      if (!changed) // what is left is glued, unless an earlier call has done that
        for (const Joining& c : candidates) {
          const std::vector<PolyhedronFace>& faces = blocks[c.thin].faces;
          if (done[c.thin] || std::any_of(faces.begin(), faces.end(), [&](const PolyhedronFace& face) {
                return face.glued && joints.count(face.cut) > 0;
              }))
            continue;
          done[c.thin] = 1;
          ++result.glued;
          blocks[c.thin].faces[c.face].glued = blocks[c.other].faces[c.other_face].glued = true;
        }
      std::size_t next = 0;
      for (std::size_t b = 0; b < blocks.size(); ++b)
        if (!gone[b]) {
          if (next != b)
            blocks[next] = std::move(blocks[b]);
          ++next;
        }
      blocks.resize(next);
    }
  result.assembly = std::move(assembly);
  return result;
}

} // namespace geom
