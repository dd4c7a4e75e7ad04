#include "libgeom/mesh/tet_mesh.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace geom {
namespace {

// The faces of a tet, counter-clockwise seen from outside; face i is opposite to corner i.
constexpr int tet_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct Face {
  std::array<int, 3> key; // nodes, ascending
  int tet, face;
};

std::vector<Face> sorted_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      Face face{{}, static_cast<int>(t), f};
      for (std::size_t c = 0; c < 3; ++c)
        face.key[c] = mesh.tets[t][static_cast<std::size_t>(tet_faces[f][c])];
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.key, a.tet, a.face) < std::tie(b.key, b.tet, b.face);
  });
  return faces;
}

double tet_volume(const TetMesh& mesh, const Tet& tet) {
  const Vec3& origin = mesh.nodes[tet[0]];
  return (mesh.nodes[tet[1]] - origin).dot((mesh.nodes[tet[2]] - origin).cross(mesh.nodes[tet[3]] - origin)) /
         6;
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

void validate(const TetMesh& mesh, const std::string& source) {
  if (mesh.tets.empty())
    throw InputError(source + ": no tetrahedra; a mesh of volume elements is needed, not of a surface");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (!mesh.nodes[i].allFinite())
      throw InputError(source + ": node " + std::to_string(i + 1) + " is at " + text(mesh.nodes[i]) +
                       "; every coordinate must be a finite number");
  const double size = bounding_box(mesh).size().norm();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Box box;
    Vec3 centre = Vec3::Zero();
    for (const int node : mesh.tets[t]) {
      if (node < 0 || node >= static_cast<int>(mesh.nodes.size()))
        throw InputError(source + ": tetrahedron " + std::to_string(t + 1) +
                         " names a node that is not there");
      box.extend(mesh.nodes[node]);
      centre += 0.25 * mesh.nodes[node];
    }
    const double volume = tet_volume(mesh, mesh.tets[t]), extent = box.size().norm();
    const std::string which = source + ": tetrahedron " + std::to_string(t + 1) + " near " + text(centre);
    // Coordinates carry 16 digits of the model's size: a volume below that is noise, whatever its sign.
    if (std::abs(volume) <= 1e-12 * extent * extent * std::max(extent, 1e-3 * size))
      throw InputError(which + " is flat; its four nodes must span a volume");
    if (volume < 0)
      throw InputError(which + " is inverted (volume " + text(volume) +
                       " m3); swap two of its nodes, or mesh anew");
  }
  const std::vector<Face> faces = sorted_faces(mesh);
  for (std::size_t i = 2; i < faces.size(); ++i)
    if (faces[i].key == faces[i - 2].key)
      throw InputError(source + ": tetrahedra " + std::to_string(faces[i - 2].tet + 1) + ", " +
                       std::to_string(faces[i - 1].tet + 1) + " and " + std::to_string(faces[i].tet + 1) +
                       " share one face; at most two may");
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& tet : mesh.tets)
    sum += tet_volume(mesh, tet);
  return sum;
}

Box bounding_box(const TetMesh& mesh) {
  Box box;
  for (const Vec3& x : mesh.nodes)
    box.extend(x);
  return box;
}

std::vector<OuterFace> outer_faces(const TetMesh& mesh) {
  const std::vector<Face> faces = sorted_faces(mesh);
  std::vector<std::array<int, 2>> outside; // tet, face
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].key == faces[i].key)
      ++j;
    if (j == i + 1)
      outside.push_back({faces[i].tet, faces[i].face});
    i = j;
  }
  std::sort(outside.begin(), outside.end());
  std::vector<OuterFace> out;
  for (const auto& [tet, face] : outside) {
    const Tet& corners = mesh.tets[tet];
    const int* c = tet_faces[face];
    out.push_back({{corners[c[0]], corners[c[1]], corners[c[2]]}, tet});
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
  const double least = std::cos(angle);
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
