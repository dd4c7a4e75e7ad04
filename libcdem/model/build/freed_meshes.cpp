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

template <class Nodes, class Is>
bool any(const Nodes& nodes, const Is& is) {
  return std::any_of(nodes.begin(), nodes.end(), is);
}

int corner_of(const geom::Tet& tet, int node) {
  return static_cast<int>(std::find(tet.begin(), tet.end(), node) - tet.begin());
}

// The face of a tet that has these nodes: that opposite to the corner that is left.
int face_of(const geom::Tet& tet, const geom::Triangle& nodes) {
  int left = 0 + 1 + 2 + 3;
  for (const int node : nodes)
    left -= corner_of(tet, node);
  return left;
}

BondedFace face_at(const Model& model, const MeshChunk& chunk, std::int64_t batch, int lane, int first) {
  const MeshData& data = model.mesh;
  const FaceNodes nodes = face_nodes(data, chunk, batch, lane);
  const FaceTets& tets = data.face_tets[batch * lanes + lane];
  BondedFace face;
  face.kn = data.faces[batch].kn[lane];
  face.area = data.faces[batch].area[lane];
  for (const int side : {0, 1}) {
    const int tet = side == 0 ? tets.tet_a : tets.tet_b;
    const geom::Triangle& own = side == 0 ? nodes.a : nodes.b;
    face.face.tets[side] = tet - model.blocks[chunk.block].tet_begin;
    face.face.faces[side] = face_of(model.tets[tet], own);
    for (int i = 0; i < 3; ++i)
      face.face.corners[side][i] = corner_of(model.tets[tet], own[i]);
  }
  for (int i = 0; i < 3; ++i)
    face.face.nodes[i] = data.original[nodes.a[i] - data.first_node] - first;
  if (!data.strength.empty()) {
    const FaceStrengthBatch& strength = data.strength[batch];
    face.strength = {strength.joint[lane], strength.tensile_strength[lane], strength.cohesion[lane],
                     strength.tan_friction[lane]};
  }
  return face;
}

// The bonded faces of a block, in the numbers of the mesh it was made of; first: of the originals of its nodes.
std::vector<BondedFace> faces_of(const Model& model, int block, int first) {
  const std::vector<MeshChunk>& chunks = model.mesh.chunks; // by block
  std::vector<BondedFace> faces;
  for (auto chunk = std::partition_point(chunks.begin(), chunks.end(),
                                         [&](const MeshChunk& c) { return c.block < block; });
       chunk != chunks.end() && chunk->block == block; ++chunk)
    for (int face = 0; face < chunk->faces; ++face)
      faces.push_back(face_at(model, *chunk, chunk->face_batches.begin + face / lanes, face % lanes, first));
  return faces;
}

// Splits a part at the nodes that are freed or joined, in the numbers of its mesh. The tets around them have all that changes.
void split_around(const Model& old, const std::vector<char>& was_freed, const std::vector<int>& around,
                  MeshPart& part) {
  const std::vector<char>& freed = part.seed.freed;
  const geom::TetMesh& mesh = part.seed.mesh;
  const Body& body = old.bodies[part.seed.body];
  geom::TetMesh own{mesh.nodes, {}, {}};
  for (const int tet : around) {
    own.tets.push_back(mesh.tets[tet]);
    own.region.push_back(mesh.region[tet]);
  }
  const std::vector<geom::InnerFace> inner = geom::inner_faces(own);
  const Splitting splitting{own, body.bonding, freed};
  const SplitMesh split = split_mesh(own, inner, splitting);
  const auto first_new = static_cast<int>(part.split.original.size());
  part.split.original.insert(part.split.original.end(), split.original.begin(), split.original.end());
  for (std::size_t i = 0; i < around.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (freed[own.tets[i][k]] != was_freed[own.tets[i][k]])
        part.split.tets[around[i]][k] = first_new + split.tets[i][k];

  const auto parted_by = [](const std::vector<char>& nodes) {
    return [&nodes](const BondedFace& f) { return any(f.face.nodes, [&](int n) { return nodes[n] != 0; }); };
  };
  const auto erase = [](std::vector<BondedFace>& faces, const auto& is) {
    faces.erase(std::remove_if(faces.begin(), faces.end(), is), faces.end());
  };
  std::vector<BondedFace> more = bonded_faces(own, inner, body, splitting, false);
  erase(more, parted_by(was_freed));
  erase(part.bonded, [&](const BondedFace& f) { return !parted_by(freed)(f); });
  for (BondedFace& f : more)
    for (int& tet : f.face.tets)
      tet = around[tet];
  if (!more.empty() && has_own_strengths(old)) {
    const FaceStrengths strengths(body, mesh);
    for (BondedFace& f : more)
      f.strength = strengths.of(f.face.tets[0], f.face.tets[1]);
  }
  const auto middle = static_cast<std::ptrdiff_t>(part.bonded.size());
  part.bonded.insert(part.bonded.end(), more.begin(), more.end());
  std::inplace_merge(part.bonded.begin(), part.bonded.begin() + middle, part.bonded.end(),
                     [](const BondedFace& a, const BondedFace& b) {
                       return std::make_pair(a.face.tets[0], a.face.faces[0]) <
                              std::make_pair(b.face.tets[0], b.face.faces[0]);
                     });
}

// A block of a model with more or fewer of its nodes freed. changed: gets the tets of the model around these nodes.
MeshPart freed_part(const Model& old, int block, const std::vector<char>& freed,
                    const std::vector<char>& joined, std::vector<int>& changed) {
  const Block& b = old.blocks[block];
  const MeshData& data = old.mesh;
  MeshPart part;
  part.seed = mesh_seed(old, block, freed, joined);
  part.mass = b.mass;
  const int* const original = data.original.data() - data.first_node;
  const int first = *std::min_element(original + b.node_begin, original + b.node_end);
  std::vector<char> was_freed(part.seed.freed.size(), 0);
  for (int node = b.node_begin; node < b.node_end; ++node) {
    part.split.original.push_back(original[node] - first);
    if (!was_freed.empty())
      was_freed[original[node] - first] = data.freed[node - data.first_node];
  }
  std::vector<int> around;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    geom::Tet nodes = old.tets[tet];
    for (int& node : nodes)
      node -= b.node_begin;
    part.split.tets.push_back(nodes);
    const geom::Tet& originals = part.seed.mesh.tets[tet - b.tet_begin];
    if (!was_freed.empty() && any(originals, [&](int n) { return part.seed.freed[n] != was_freed[n]; })) {
      around.push_back(tet - b.tet_begin);
      changed.push_back(tet);
    }
  }
  part.bonded = faces_of(old, block, first);
  if (!around.empty())
    split_around(old, was_freed, around, part);
  each_boundary_triangle(old, block, [&](int, const BoundaryTriangle& triangle) {
    part.outer.push_back({{}, triangle.tet - b.tet_begin, face_of(old.tets[triangle.tet], triangle.nodes)});
  });
  return part;
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

FreedModel with_freed_nodes(const Model& old, const std::vector<char>& freed,
                            const std::vector<char>& joined) {
  const auto first = static_cast<std::size_t>(
      std::find_if(old.blocks.begin(), old.blocks.end(), [](const Block& b) { return !b.convex(); }) -
      old.blocks.begin());
  FreedModel now{without_meshes(old, first), {}};
  Model& model = now.model;
  // What names places of convex blocks stays.
  for (const auto& [key, faces] : old.mesh.named)
    for (const int face : faces)
      if (face < static_cast<int>(model.mesh.boundary.size()))
        model.mesh.named[key].push_back(face);
  for (std::size_t b = first; b < old.blocks.size(); ++b) {
    add_part(model, freed_part(old, static_cast<int>(b), freed, joined, now.tets));
    model.blocks[b].rigid = old.blocks[b].rigid;
  }
  end_parts(model);
  model.bond_begin.resize(model.node_position.size() + 1,
                          model.bond_begin.empty() ? 0 : model.bond_begin.back());
  // Springs of interfaces are on nodes before the mesh parts.
  for (std::size_t node = static_cast<std::size_t>(old.blocks[first].node_begin) + 1;
       node < model.bond_begin.size(); ++node)
    model.bond_begin[node] = static_cast<std::int64_t>(model.spring_ends.size());
  build_surface(model, &old.surface);
  return now;
}

} // namespace cdem
