#include "libgeom/mesh/tet_mesh.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

double tet_volume(const TetMesh& mesh, const Tet& tet) {
  const Vec3& origin = mesh.nodes[tet[0]];
  return (mesh.nodes[tet[1]] - origin).dot((mesh.nodes[tet[2]] - origin).cross(mesh.nodes[tet[3]] - origin)) /
         6;
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
  try {
    face_neighbours(mesh.tets, mesh.nodes.size());
  } catch (const InputError& e) {
    throw InputError(source + ": " + e.what());
  }
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

MassProperties mass_properties(const TetMesh& mesh) {
  // About a node of the mesh, so that one far from the global origin keeps its digits. Over a tet with
  // corners p, q, r, s:  int x dV = V/4 (p + q + r + s),  int x xT dV = V/20 (p pT + ... + s sT + m mT),
  // m = p + q + r + s.
  const Vec3& origin = mesh.nodes.front();
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Tet& tet : mesh.tets) {
    const double v = tet_volume(mesh, tet);
    Vec3 sum = Vec3::Zero();
    Mat3 products = Mat3::Zero();
    for (const int node : tet) {
      const Vec3 x = mesh.nodes[node] - origin;
      sum += x;
      products += x * x.transpose();
    }
    volume += v;
    first += v / 4 * sum;
    second += v / 20 * (products + sum * sum.transpose());
  }
  const Vec3 centroid = first / volume;
  second -= volume * centroid * centroid.transpose();
  return {volume, origin + centroid, second.trace() * Mat3::Identity() - second};
}

} // namespace geom
