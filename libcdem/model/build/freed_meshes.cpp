#include "libcdem/model/build/freed_meshes.hpp"

#include "libcdem/model/build/contact_surface.hpp"

#include <algorithm>

namespace cdem {
namespace {

// The part of a model before its mesh parts, which begin with the block `first`.
Model without_meshes(const Model& old, std::size_t first) {
  Model model = old;
  const auto cut = [](auto& array, std::size_t size) {
    if (array.size() > size)
      array.erase(array.begin() + static_cast<std::ptrdiff_t>(size), array.end());
  };
  const auto nodes = static_cast<std::size_t>(old.blocks[first].node_begin);
  const auto tets = static_cast<std::size_t>(old.blocks[first].tet_begin);
  cut(model.blocks, first);
  cut(model.node_position, nodes);
  cut(model.node_mass, nodes);
  cut(model.gravitational_mass, nodes);
  cut(model.tets, tets);
  cut(model.tet_block, tets);
  const auto before = [&](const auto& entry) { return entry.block < static_cast<int>(first); };
  model.outer_faces.erase(std::partition_point(model.outer_faces.begin(), model.outer_faces.end(), before),
                          model.outer_faces.end());

  MeshData& data = model.mesh;
  const auto chunks = static_cast<std::size_t>(
      std::partition_point(data.chunks.begin(), data.chunks.end(), before) - data.chunks.begin());
  cut(model.chunks, model.chunks.size() - (data.chunks.size() - chunks));
  if (chunks < data.chunks.size()) {
    const MeshChunk& head = data.chunks[chunks];
    cut(data.batches, static_cast<std::size_t>(head.batches.begin));
    cut(data.faces, static_cast<std::size_t>(head.face_batches.begin));
    cut(data.strength, static_cast<std::size_t>(head.face_batches.begin));
    cut(data.sides, static_cast<std::size_t>(head.side_batches.begin));
    cut(data.others, static_cast<std::size_t>(head.others.begin));
  }
  cut(data.chunks, chunks);
  cut(data.face_tets, data.faces.size() * lanes);
  cut(data.tet_slot, tets - static_cast<std::size_t>(data.first_tet));
  cut(data.region, tets - static_cast<std::size_t>(data.first_tet));
  cut(data.original, nodes - static_cast<std::size_t>(data.first_node));
  cut(data.freed, nodes - static_cast<std::size_t>(data.first_node));
  data.boundary.erase(std::partition_point(data.boundary.begin(), data.boundary.end(), before),
                      data.boundary.end());
  data.named.clear();
  data.share_begin.clear();
  data.shares.clear();
  return model;
}

} // namespace

MeshSeed mesh_seed(const Model& old, int block, const std::vector<char>& freed,
                   const std::vector<char>& joined) {
  const Block& b = old.blocks[block];
  const MeshData& data = old.mesh;
  MeshSeed seed;
  seed.id = b.id;
  seed.body = b.body;
  seed.unit = b.unit;
  seed.ordered = true;
  const int* const original = data.original.data() - data.first_node;
  const auto [least, most] = std::minmax_element(original + b.node_begin, original + b.node_end);
  const int first = *least, count = *most - first + 1;
  seed.mesh.nodes.resize(static_cast<std::size_t>(count), geom::Vec3::Zero());
  const bool cohesive = old.bodies[b.body].bonding.is_cohesive();
  if (cohesive)
    seed.freed.resize(static_cast<std::size_t>(count), 0);
  for (int node = b.node_begin; node < b.node_end; ++node) {
    seed.mesh.nodes[original[node] - first] = old.node_position[node];
    if (cohesive && ((!freed.empty() && freed[node] != 0) ||
                     (data.freed[node - data.first_node] != 0 && (joined.empty() || joined[node] == 0))))
      seed.freed[original[node] - first] = 1;
  }
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    geom::Tet nodes = old.tets[tet];
    for (int& node : nodes)
      node = original[node] - first;
    seed.mesh.tets.push_back(nodes);
    seed.mesh.region.push_back(data.region[tet - data.first_tet]);
  }
  const auto boundary = std::partition_point(data.boundary.begin(), data.boundary.end(),
                                             [&](const BoundaryTriangle& t) { return t.block < block; });
  const auto begin = static_cast<int>(boundary - data.boundary.begin());
  auto end = begin;
  while (end < static_cast<int>(data.boundary.size()) && data.boundary[end].block == block)
    ++end;
  for (const auto& [key, faces] : data.named)
    for (const int face : faces)
      if (key.first == b.body && face >= begin && face < end)
        seed.mesh.named[key.second].push_back(face - begin);
  return seed;
}

Model with_freed_nodes(const Model& old, const std::vector<char>& freed, const std::vector<char>& joined) {
  const auto first = static_cast<std::size_t>(
      std::find_if(old.blocks.begin(), old.blocks.end(), [](const Block& b) { return !b.convex(); }) -
      old.blocks.begin());
  Model model = without_meshes(old, first);
  // What names places of convex blocks stays.
  for (const auto& [key, faces] : old.mesh.named)
    for (const int face : faces)
      if (face < static_cast<int>(model.mesh.boundary.size()))
        model.mesh.named[key].push_back(face);
  std::vector<MeshSeed> seeds;
  for (std::size_t b = first; b < old.blocks.size(); ++b)
    seeds.push_back(mesh_seed(old, static_cast<int>(b), freed, joined));
  add_meshes(model, std::move(seeds));
  for (std::size_t b = first; b < old.blocks.size(); ++b)
    model.blocks[b].rigid = old.blocks[b].rigid;
  model.bond_begin.resize(model.node_position.size() + 1,
                          model.bond_begin.empty() ? 0 : model.bond_begin.back());
  // Springs of interfaces are on nodes before the mesh parts.
  for (std::size_t node = static_cast<std::size_t>(old.blocks[first].node_begin) + 1;
       node < model.bond_begin.size(); ++node)
    model.bond_begin[node] = static_cast<std::int64_t>(model.spring_ends.size());
  build_surface(model);
  return model;
}

} // namespace cdem
