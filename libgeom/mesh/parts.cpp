#include "libgeom/mesh/parts.hpp"

#include "libgeom/core/disjoint_sets.hpp"
#include "libgeom/mesh/boundary.hpp"

namespace geom {

std::vector<int> part_of_tets(const TetMesh& mesh) {
  DisjointSets sets(mesh.nodes.size());
  for (const Tet& tet : mesh.tets)
    for (int corner = 1; corner < 4; ++corner)
      sets.unite(tet[0], tet[corner]);
  std::vector<int> number(mesh.nodes.size(), -1), part; // number: of the part, at the node that stands for it
  int next = 0;
  for (const Tet& tet : mesh.tets) {
    int& n = number[sets.find(tet[0])];
    if (n < 0)
      n = next++;
    part.push_back(n);
  }
  return part;
}

int count_parts(const TetMesh& mesh) {
  const std::vector<int> part = part_of_tets(mesh);
  return part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;
}

std::vector<TetMesh> parts(const TetMesh& mesh) {
  const std::vector<int> part = part_of_tets(mesh);
  const int count = part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;
  if (count < 2)
    return {mesh};
  std::vector<TetMesh> all(count);
  std::vector<int> part_of_node(mesh.nodes.size(), -1), node_in_part(mesh.nodes.size(), -1);
  for (std::size_t t = 0; t < part.size(); ++t)
    for (const int node : mesh.tets[t])
      part_of_node[node] = part[t];
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (part_of_node[n] >= 0) {
      std::vector<Vec3>& nodes = all[part_of_node[n]].nodes;
      node_in_part[n] = static_cast<int>(nodes.size());
      nodes.push_back(mesh.nodes[n]);
    }
  for (std::size_t t = 0; t < part.size(); ++t) {
    Tet tet = mesh.tets[t];
    for (int& node : tet)
      node = node_in_part[node];
    all[part[t]].tets.push_back(tet);
    if (!mesh.region.empty())
      all[part[t]].region.push_back(mesh.region[t]);
  }
  if (mesh.named.empty())
    return all;
  // Outer faces come by tet, so that those of a part keep their order.
  const std::vector<OuterFace> outer = outer_faces(mesh);
  std::vector<int> number(outer.size()), faces(count, 0);
  for (std::size_t f = 0; f < outer.size(); ++f)
    number[f] = faces[part[outer[f].tet]]++;
  for (const auto& [name, chosen] : mesh.named)
    for (const int f : chosen)
      all[part[outer[f].tet]].named[name].push_back(number[f]);
  return all;
}

} // namespace geom
