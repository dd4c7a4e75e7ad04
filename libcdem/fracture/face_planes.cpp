#include "libcdem/fracture/strength_watch.hpp"

#include "libgeom/mesh/boundary.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace cdem {

// A border that a mesh follows is smooth: of the three faces beyond the edges of a face at most one stands far off it, where
// the border has an edge. A ragged border, which only says to which region each tet belongs, has no plane of its own: its
// faces, and those beside them, are judged as faces of the material; all of the border's, where most are ragged.
void StrengthWatch::find_planes(const Model& model) {
  // Least cosine between faces side by side, of 20 degrees: a circle of 18 edges is smooth.
  constexpr double smooth = 0.93969262078590838;
  const MeshData& mesh = model.mesh;
  struct BorderFace {
    std::size_t at;
    geom::Vec3 normal;
    std::array<std::pair<int, int>, 3> edges; // by the numbers that all copies of a node have
    std::array<int, 3> between;               // body and regions
    bool ragged;
  };
  std::vector<BorderFace> border;
  std::map<std::pair<int, int>, std::vector<std::size_t>> around; // of each edge: into border
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    const int tet = static_cast<int>(i / 4), beyond = neighbours_[i] / 4;
    if (neighbours_[i] < 0 || beyond < tet)
      continue;
    const Body& body = model.bodies[model.blocks[model.tet_block[mesh.first_tet + tet]].body];
    if (!body.bonding.is_cohesive())
      continue;
    const int a = mesh.region[tet], b = mesh.region[beyond];
    if (a == b || (body.bonding.everywhere && body.region_laws.between(a, b) < 0))
      continue;
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k)
      corners[k] = model.tets[mesh.first_tet + tet][geom::tet_faces[i % 4][k]];
    const auto place = [&](int k) { return model.node_position[corners[k]]; };
    BorderFace face{
        i,
        (place(1) - place(0)).cross(place(2) - place(0)).normalized(),
        {},
        {model.blocks[model.tet_block[mesh.first_tet + tet]].body, std::min(a, b), std::max(a, b)},
        false};
    for (int k = 0; k < 3; ++k) {
      const int one = mesh.original[corners[k] - mesh.first_node],
                other = mesh.original[corners[(k + 1) % 3] - mesh.first_node];
      face.edges[k] = std::minmax(one, other);
      around[face.edges[k]].push_back(border.size());
    }
    border.push_back(face);
  }
  if (border.empty())
    return;
  const auto count_beside = [&](const BorderFace& face, const auto& is) { // edges beyond which one is
    return std::count_if(face.edges.begin(), face.edges.end(), [&](const auto& edge) {
      const std::vector<std::size_t>& beside = around.at(edge);
      return std::any_of(beside.begin(), beside.end(), [&](std::size_t other) { return is(border[other]); });
    });
  };
  for (BorderFace& face : border)
    face.ragged = count_beside(face, [&](const BorderFace& other) {
                    return std::abs(other.normal.dot(face.normal)) < smooth;
                  }) > 1;
  std::map<std::array<int, 3>, std::int64_t> most; // > 0: more ragged faces than others
  for (const BorderFace& face : border)
    most[face.between] += face.ragged ? 1 : -1;
  plane_.assign(neighbours_.size(), FacePlane::of_material);
  for (const BorderFace& face : border)
    plane_[face.at] = plane_[static_cast<std::size_t>(neighbours_[face.at])] =
        most[face.between] <= 0 &&
                count_beside(face, [](const BorderFace& other) { return other.ragged; }) == 0
            ? FacePlane::own
            : FacePlane::of_ragged_border;
}

} // namespace cdem
