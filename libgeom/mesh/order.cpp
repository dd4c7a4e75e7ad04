#include "libgeom/mesh/order.hpp"

#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace geom {
namespace {

// The outer faces of `to`, which has the tets of `from` in another order, that are the named ones of `from`.
NamedFaces carried_over(const TetMesh& from, const TetMesh& to, const std::vector<int>& new_tet) {
  NamedFaces named;
  if (from.named.empty())
    return named;
  const std::vector<OuterFace> before = outer_faces(from), now = outer_faces(to);
  std::vector<int> index(4 * to.tets.size(), -1);
  for (int i = 0; i < static_cast<int>(now.size()); ++i)
    index[4 * now[i].tet + now[i].face] = i;
  for (const auto& [name, faces] : from.named) {
    std::vector<int>& there = named[name];
    for (const int face : faces)
      there.push_back(index[4 * new_tet[before[face].tet] + before[face].face]);
    std::sort(there.begin(), there.end());
  }
  return named;
}

} // namespace

MeshOrder hilbert_order(const TetMesh& mesh) {
  std::vector<Vec3> centres;
  centres.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets)
    centres.emplace_back(0.25 * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]));

  MeshOrder order;
  order.tets = along_hilbert_curve(centres, bounding_box(mesh));
  order.nodes.reserve(mesh.nodes.size());
  std::vector<char> met(mesh.nodes.size(), 0);
  const auto meet = [&](int node) {
    if (met[node])
      return;
    met[node] = 1;
    order.nodes.push_back(node);
  };
  for (const int tet : order.tets)
    for (const int node : mesh.tets[tet])
      meet(node);
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node)
    meet(node);
  return order;
}

std::vector<int> inverse(const std::vector<int>& permutation) {
  std::vector<int> out(permutation.size());
  for (std::size_t i = 0; i < permutation.size(); ++i)
    out[permutation[i]] = static_cast<int>(i);
  return out;
}

TetMesh reordered(const TetMesh& mesh, const MeshOrder& order) {
  const std::vector<int> new_node = inverse(order.nodes);
  TetMesh out;
  out.nodes.reserve(mesh.nodes.size());
  out.tets.reserve(mesh.tets.size());
  out.region.reserve(mesh.region.size());
  for (const int node : order.nodes)
    out.nodes.push_back(mesh.nodes[node]);
  for (const int old : order.tets) {
    Tet tet = mesh.tets[old];
    for (int& node : tet)
      node = new_node[node];
    out.tets.push_back(tet);
    if (!mesh.region.empty())
      out.region.push_back(mesh.region[old]);
  }
  out.named = carried_over(mesh, out, inverse(order.tets));
  return out;
}

TetMesh ordered(const TetMesh& mesh) {
  return reordered(mesh, hilbert_order(mesh));
}

} // namespace geom
