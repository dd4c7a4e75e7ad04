#include "libcdem/results/units.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace cdem {
namespace {

std::vector<int> units_named(const Model& model, const std::string& body) {
  std::vector<int> blocks = units_of_body(model, body);
  if (blocks.empty())
    refuse_body("body", body, model);
  return blocks;
}

struct LargestPiece {
  std::vector<int> nodes; // ascending
  int pieces = 1;
  double share = 1; // of the unit's volume
};

// fragment: of each node; empty: all units are whole.
LargestPiece largest_piece(const Model& model, const Block& block, const std::vector<int>& fragment) {
  LargestPiece piece;
  std::map<int, double> volumes; // m3, by fragment
  double whole = 0;
  for (int t = block.tet_begin; t < block.tet_end && !fragment.empty(); ++t) {
    const double volume = tet_volume(model, t);
    volumes[fragment[model.tets[t][0]]] += volume;
    whole += volume;
  }
  if (volumes.size() < 2) {
    piece.nodes.resize(static_cast<std::size_t>(block.node_end - block.node_begin));
    std::iota(piece.nodes.begin(), piece.nodes.end(), block.node_begin);
    return piece;
  }
  const auto largest = std::max_element(volumes.begin(), volumes.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  for (int node = block.node_begin; node < block.node_end; ++node)
    if (fragment[node] == largest->first)
      piece.nodes.push_back(node);
  piece.pieces = static_cast<int>(volumes.size());
  piece.share = largest->second / whole;
  return piece;
}

} // namespace

std::vector<Unit> units_of(const Model& model, const State& state, const std::string& body) {
  std::vector<Unit> units;
  const std::vector<int> blocks = units_named(model, body);
  const bool can_break = !model.bodies[model.blocks[blocks[0]].body].bonding.none();
  const std::vector<int> fragment = can_break ? fragments_of_nodes(model, state) : std::vector<int>{};
  for (const int b : blocks) {
    const Block& block = model.blocks[b];
    const LargestPiece piece = largest_piece(model, block, fragment);
    std::vector<geom::Vec3> before, now;
    std::vector<double> mass;
    for (const int node : piece.nodes) {
      before.push_back(model.node_position[node]);
      now.push_back(place_of(model, state, node));
      mass.push_back(model.node_mass[node]);
    }
    Unit unit{b, {}, geom::best_fit(before, now, mass), piece.pieces, piece.share};
    unit.centroid = piece.pieces > 1 ? unit.motion(block.mass.centroid)
                                     : block.mass.centroid + centroid_displacement(model, state, b);
    units.push_back(unit);
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
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const int u = unit_of[chunk.block];
    if (u < 0 || is_bonded(state, batch, lane))
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    for (geom::Triangle side : {nodes.a, nodes.outward_b()}) {
      for (int& node : side)
        node -= model.blocks[chunk.block].node_begin;
      surfaces[u].triangles.push_back(side);
    }
  });
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
