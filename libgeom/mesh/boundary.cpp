#include "libgeom/mesh/boundary.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

// Things keyed by node numbers, put together by the first of them: a counting sort, so that time goes with
// their number. The entries of node n are those from start[n] to start[n + 1].
template <class Entry>
struct ByNode {
  std::vector<std::size_t> start;
  std::vector<Entry> entries;
};

// each(add) calls add(node, entry) for all entries, in the same order both times it is run.
template <class Entry, class Each>
ByNode<Entry> by_node(std::size_t node_count, Each each) {
  ByNode<Entry> out;
  out.start.assign(node_count + 1, 0);
  each([&](int node, const Entry&) { ++out.start[static_cast<std::size_t>(node) + 1]; });
  for (std::size_t n = 0; n < node_count; ++n)
    out.start[n + 1] += out.start[n];
  out.entries.resize(out.start.back());
  std::vector<std::size_t> next(out.start.begin(), out.start.end() - 1);
  each([&](int node, const Entry& entry) { out.entries[next[static_cast<std::size_t>(node)]++] = entry; });
  return out;
}

Triangle nodes_of(const Tet& tet, std::size_t face) {
  const auto& c = tet_faces[face];
  return {tet[c[0]], tet[c[1]], tet[c[2]]};
}

Vec3 area_vector(const TetMesh& mesh, const Triangle& t) {
  return 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]);
}

template <class Holds>
std::vector<int> select(const std::vector<OuterFace>& faces, Holds holds) {
  std::vector<int> chosen;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (holds(faces[i]))
      chosen.push_back(static_cast<int>(i));
  return chosen;
}

} // namespace

std::vector<int> face_neighbours(const std::vector<Tet>& tets, std::size_t node_count) {
  struct Entry {
    std::array<int, 2> rest; // the two higher nodes, ascending
    int number;              // 4 tet + face
  };
  auto faces = by_node<Entry>(node_count, [&](auto add) {
    for (std::size_t t = 0; t < tets.size(); ++t)
      for (std::size_t f = 0; f < 4; ++f) {
        Triangle key = nodes_of(tets[t], f);
        std::sort(key.begin(), key.end());
        add(key[0], Entry{{key[1], key[2]}, static_cast<int>(4 * t + f)});
      }
  });
  std::vector<int> neighbours(4 * tets.size(), -1);
  const auto entry = [&](std::size_t i) { return faces.entries.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t n = 0; n < node_count; ++n) {
    const std::size_t end = faces.start[n + 1];
    std::sort(entry(faces.start[n]), entry(end), [](const Entry& a, const Entry& b) {
      return a.rest != b.rest ? a.rest < b.rest : a.number < b.number;
    });
    for (std::size_t i = faces.start[n]; i + 1 < end; ++i) {
      const Entry &a = faces.entries[i], &b = faces.entries[i + 1];
      if (a.rest != b.rest)
        continue;
      if (neighbours[a.number] >= 0)
        throw InputError("tetrahedra " + std::to_string(neighbours[a.number] / 4 + 1) + ", " +
                         std::to_string(a.number / 4 + 1) + " and " + std::to_string(b.number / 4 + 1) +
                         " share one face; at most two may");
      neighbours[a.number] = b.number;
      neighbours[b.number] = a.number;
    }
  }
  return neighbours;
}

std::vector<OuterFace> outer_faces(const TetMesh& mesh) {
  return outer_faces(mesh, face_neighbours(mesh.tets, mesh.nodes.size()));
}

std::vector<OuterFace> outer_faces(const TetMesh& mesh, const std::vector<int>& neighbours) {
  std::vector<OuterFace> out;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f)
      if (neighbours[4 * t + f] < 0)
        out.push_back({nodes_of(mesh.tets[t], f), static_cast<int>(t), static_cast<int>(f)});
  return out;
}

std::vector<InnerFace> inner_faces(const TetMesh& mesh) {
  return inner_faces(mesh, face_neighbours(mesh.tets, mesh.nodes.size()));
}

std::vector<InnerFace> inner_faces(const TetMesh& mesh, const std::vector<int>& neighbours) {
  std::vector<InnerFace> out;
  out.reserve(2 * mesh.tets.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const int other = neighbours[i];
    if (other < static_cast<int>(i)) // outside, or seen from the lower tet already
      continue;
    InnerFace face;
    face.tets = {static_cast<int>(i / 4), other / 4};
    face.faces = {static_cast<int>(i % 4), other % 4};
    face.nodes = nodes_of(mesh.tets[i / 4], i % 4);
    face.corners[0] = tet_faces[i % 4];
    const Tet& second = mesh.tets[face.tets[1]];
    for (std::size_t c = 0; c < 3; ++c)
      face.corners[1][c] =
          static_cast<int>(std::find(second.begin(), second.end(), face.nodes[c]) - second.begin());
    out.push_back(face);
  }
  return out;
}

std::vector<int> faces_on_plane(const TetMesh& mesh, const std::vector<OuterFace>& faces, const Plane& plane,
                                double tolerance) {
  return select(faces, [&](const OuterFace& face) {
    return std::all_of(face.nodes.begin(), face.nodes.end(),
                       [&](int n) { return std::abs(plane.level(mesh.nodes[n])) <= tolerance; });
  });
}

std::vector<int> faces_on_side(const TetMesh& mesh, const std::vector<OuterFace>& faces,
                               const std::string& side) {
  const auto axis = side.size() == 2 ? std::string("xyz").find(side[0]) : std::string::npos;
  if (axis == std::string::npos || (side[1] != '-' && side[1] != '+'))
    throw InputError("side", '"' + side + '"', "one of x-, x+, y-, y+, z-, z+");
  const Box box = bounding_box(mesh);
  const int a = static_cast<int>(axis);
  const double place = side[1] == '+' ? box.max[a] : box.min[a];
  return faces_on_plane(mesh, faces, {Vec3::Unit(a), place}, 1e-6 * box.size().norm());
}

std::vector<int> faces_towards(const TetMesh& mesh, const std::vector<OuterFace>& faces,
                               const Vec3& direction, double angle) {
  if (!direction.allFinite() || !(direction.norm() > 0))
    throw InputError("direction", text(direction), "finite and longer than zero");
  const Vec3 unit = direction.normalized();
  const double least = portable::cos(angle);
  return select(faces, [&](const OuterFace& face) {
    return area_vector(mesh, face.nodes).normalized().dot(unit) >= least;
  });
}

FaceGroup measure(const TetMesh& mesh, const std::vector<OuterFace>& faces, const std::vector<int>& chosen) {
  FaceGroup group;
  for (const int i : chosen) {
    const Triangle& t = faces[i].nodes;
    const Vec3 vector = area_vector(mesh, t);
    group.area += vector.norm();
    group.area_vector += vector;
    group.centroid += vector.norm() * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3;
  }
  if (group.area > 0)
    group.centroid /= group.area;
  return group;
}

} // namespace geom
