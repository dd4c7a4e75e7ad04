#include "libcdem/results/units.hpp"

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <set>

namespace cdem {
namespace {

std::vector<int> units_named(const Model& model, const std::string& body) {
  std::vector<int> blocks = units_of_body(model, body);
  if (blocks.empty())
    refuse_body("body", body, model);
  return blocks;
}

} // namespace

std::vector<Unit> units_of(const Model& model, const State& state, const std::string& body) {
  std::vector<Unit> units;
  for (const int b : units_named(model, body)) {
    const Block& block = model.blocks[b];
    std::vector<geom::Vec3> places;
    for (int node = block.node_begin; node < block.node_end; ++node)
      places.push_back(place_of(model, state, node));
    const auto part = [&](const auto& of_nodes) {
      return std::vector(of_nodes.begin() + block.node_begin, of_nodes.begin() + block.node_end);
    };
    units.push_back({b, block.mass.centroid + centroid_displacement(model, state, b),
                     geom::best_fit(part(model.node_position), places, part(model.node_mass))});
  }
  return units;
}

std::vector<geom::Surface> surfaces_of(const Model& model, const State& state, const std::string& body) {
  const std::vector<int> blocks = units_named(model, body);
  std::vector<int> unit_of(model.blocks.size(), -1);
  std::vector<geom::Surface> surfaces(blocks.size());
  for (std::size_t u = 0; u < blocks.size(); ++u) {
    const Block& block = model.blocks[blocks[u]];
    unit_of[blocks[u]] = static_cast<int>(u);
    for (int node = block.node_begin; node < block.node_end; ++node)
      surfaces[u].points.push_back(place_of(model, state, node));
    if (!block.meshed) // of a star block, the face of each tet that is opposite to the centroid
      for (int t = block.tet_begin; t < block.tet_end; ++t)
        surfaces[u].triangles.push_back({model.tets[t][1] - block.node_begin,
                                         model.tets[t][2] - block.node_begin,
                                         model.tets[t][3] - block.node_begin});
  }
  for (const BoundaryTriangle& triangle : model.mesh.boundary)
    if (const int u = unit_of[triangle.block]; u >= 0) {
      geom::Triangle own = triangle.nodes;
      for (int& node : own)
        node -= model.blocks[triangle.block].node_begin;
      surfaces[u].triangles.push_back(own);
    }
  return surfaces;
}

std::vector<int> touching(const Model& model, const State& state, const std::string& body) {
  std::set<std::pair<int, int>> pairs;
  for (const Contact& contact : state.contacts) {
    if (!(contact.effective_penetration() > 0))
      continue;
    const auto [a, b] = cdem::blocks_of(model, contact);
    if (a != b) {
      pairs.emplace(a, b);
      pairs.emplace(b, a);
    }
  }
  std::vector<int> count;
  for (const int block : units_named(model, body))
    count.push_back(static_cast<int>(
        std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == block; })));
  return count;
}

namespace {

// Mean of a vector of the nodes of a block, weighted by mass.
geom::Vec3 mean_of_nodes(const Model& model, const std::vector<Node>& values, const Block& block) {
  geom::Vec3 moment = geom::Vec3::Zero();
  double mass = 0;
  for (int node = block.node_begin; node < block.node_end; ++node) {
    moment += model.node_mass[node] * vec(values[node]);
    mass += model.node_mass[node];
  }
  return moment / mass;
}

geom::Vec3 at_centroid(const Model& model, const std::vector<Node>& values, const Block& block) {
  return block.meshed ? mean_of_nodes(model, values, block) : vec(values[block.centroid_node()]);
}

} // namespace

geom::Vec3 mean_displacement(const Model& model, const State& state, int b) {
  return mean_of_nodes(model, state.displacement, model.blocks[b]);
}

geom::Vec3 centroid_displacement(const Model& model, const State& state, int b) {
  return at_centroid(model, state.displacement, model.blocks[b]);
}

geom::Vec3 shown_centroid_displacement(const Model& model, const State& state, int b) {
  geom::Vec3 moved = centroid_displacement(model, state, b);
  if (state.displacement_zero.empty())
    return moved;
  return moved - at_centroid(model, state.displacement_zero, model.blocks[b]);
}

} // namespace cdem
