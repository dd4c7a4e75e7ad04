#include "libgeom/mesh/order.hpp"

#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace geom {
namespace {

constexpr int bits = 21; // of each axis; three fit into 64

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

std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  // Skilling's AxesToTranspose: undo the turns of the sub-cubes from the largest to the smallest, then Gray
  // code.
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t low = q - 1;
    for (std::uint32_t& axis : x)
      if ((axis & q) != 0)
        x[0] ^= low;
      else {
        const std::uint32_t swapped = (x[0] ^ axis) & low;
        x[0] ^= swapped;
        axis ^= swapped;
      }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turned = 0;
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1)
    if ((x[2] & q) != 0)
      turned ^= q - 1;
  std::uint64_t index = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (const std::uint32_t axis : x)
      index = index << 1 | (((axis ^ turned) >> bit) & 1U);
  return index;
}

MeshOrder hilbert_order(const TetMesh& mesh) {
  const Box box = bounding_box(mesh);
  constexpr double cells = 1U << bits;
  const double size = mesh.nodes.empty() ? 0 : box.size().maxCoeff();
  const double scale = size > 0 ? cells / size : 0;
  std::vector<std::pair<std::uint64_t, int>> keys;
  keys.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    const Vec3 centre = 0.25 * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]);
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      cell[i] = static_cast<std::uint32_t>(std::clamp((centre[axis] - box.min[axis]) * scale, 0., cells - 1));
    }
    keys.emplace_back(hilbert_index(cell), static_cast<int>(keys.size()));
  }
  std::sort(keys.begin(), keys.end());

  MeshOrder order;
  order.tets.reserve(mesh.tets.size());
  order.nodes.reserve(mesh.nodes.size());
  std::vector<char> met(mesh.nodes.size(), 0);
  const auto meet = [&](int node) {
    if (met[node])
      return;
    met[node] = 1;
    order.nodes.push_back(node);
  };
  for (const auto& [key, tet] : keys) {
    order.tets.push_back(tet);
    for (const int node : mesh.tets[tet])
      meet(node);
  }
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
