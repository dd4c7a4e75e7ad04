#include "libcdem/model/build/add_meshes.hpp"

#include "libcdem/model/build/light_corners.hpp"
#include "libgeom/mesh/order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

// Tets of a chunk, and the most of them: nodes and forces of the first stay in the first cache where every tet has nodes
// of its own, those of the second where nodes are shared. The larger a chunk, the fewer nodes are touched by several.
constexpr int tets_per_chunk = 512, most_tets_per_chunk = 2048;
// Below the most, a mesh makes so many chunks, which threads share among them.
constexpr int chunks_per_mesh = 64;

// That of a cohesive body does not change as nodes are freed.
int chunk_size(const SplitMesh& split, const Bonding& bonding) {
  const auto tets = static_cast<int>(split.tets.size());
  if (!bonding.is_cohesive() && split.original.size() > split.tets.size())
    return tets_per_chunk;
  return std::clamp(tets / chunks_per_mesh / lanes * lanes, tets_per_chunk, most_tets_per_chunk);
}

// Gives the nodes that a chunk uses their places: its own first, the others as they come.
class Places {
public:
  // Only chunks that use these nodes of the model count.
  explicit Places(Range nodes) : first_(nodes.begin), place_(static_cast<std::size_t>(nodes.size()), -1) {}
  void start(Range own) {
    for (const int node : others_)
      place_[node - first_] = -1;
    others_.clear();
    own_ = own;
  }
  std::uint16_t of(int node) {
    if (node >= own_.begin && node < own_.end)
      return static_cast<std::uint16_t>(node - own_.begin);
    int& place = place_[node - first_];
    if (place < 0) {
      place = static_cast<int>(own_.size()) + static_cast<int>(others_.size());
      others_.push_back(node);
    }
    return static_cast<std::uint16_t>(place);
  }
  const std::vector<int>& others() const { return others_; }

private:
  std::int64_t first_;
  std::vector<int> place_, others_;
  Range own_;
};

void add_strengths(MeshData& data, const std::vector<BondedFace>& faces) {
  for (std::size_t begin = 0; begin < faces.size(); begin += lanes) {
    FaceStrengthBatch batch{};
    for (int lane = 0; lane < lanes; ++lane) {
      const FaceStrength& own = faces[begin + lane < faces.size() ? begin + lane : begin].strength;
      batch.tensile_strength[lane] = own.tensile_strength;
      batch.cohesion[lane] = own.cohesion;
      batch.tan_friction[lane] = own.tan_friction;
      batch.joint[lane] = own.joint;
    }
    data.strength.push_back(batch);
  }
}

void add_faces(MeshData& data, const std::vector<BondedFace>& faces, int first_tet,
               const std::vector<geom::Tet>& tets, Places& places) {
  for (std::size_t begin = 0; begin < faces.size(); begin += lanes) {
    FaceBatch batch{};
    for (int lane = 0; lane < lanes; ++lane) {
      const bool used = begin + lane < faces.size();
      const BondedFace& f = faces[used ? begin + lane : begin];
      for (int i = 0; i < 3; ++i) {
        const int a = tets[first_tet + f.face.tets[0]][f.face.corners[0][i]];
        const int b = tets[first_tet + f.face.tets[1]][f.face.corners[1][i]];
        batch.place_a[i][lane] = places.of(a);
        batch.place_b[i][lane] = places.of(b);
      }
      batch.kn[lane] = used ? f.kn : 0;
      batch.area[lane] = f.area;
      data.face_tets.push_back(used ? FaceTets{first_tet + f.face.tets[0], first_tet + f.face.tets[1]}
                                    : FaceTets{});
    }
    data.faces.push_back(batch);
  }
}

void add_tets(MeshData& data, Range tets, const std::vector<geom::Tet>& all, Places& places) {
  for (std::int64_t begin = tets.begin; begin < tets.end; begin += lanes) {
    MeshBatch batch{};
    for (int lane = 0; lane < lanes; ++lane) {
      const bool used = begin + lane < tets.end;
      const geom::Tet& tet = all[used ? begin + lane : begin];
      for (int corner = 0; corner < 4; ++corner)
        batch.place[corner][lane] = places.of(tet[corner]);
      if (used)
        data.tet_slot.push_back(static_cast<int>(data.batches.size()) * lanes + lane);
    }
    data.batches.push_back(batch);
  }
}

// Nodes that a chunk is the first to use follow each other.
int nodes_end(const std::vector<geom::Tet>& tets, Range range, int begin) {
  int end = begin;
  for (std::int64_t t = range.begin; t < range.end; ++t)
    for (const int node : tets[t])
      end = std::max(end, node + 1);
  return end;
}

void add_nodes(Model& model, const geom::TetMesh& mesh, const SplitMesh& split, int block) {
  const double density = model.bodies[model.blocks[block].body].material.density;
  const int first = model.blocks[block].node_begin;
  int first_original = 0; // they ascend from block to block
  if (!model.mesh.original.empty())
    first_original = *std::max_element(model.mesh.original.begin() + model.blocks[block - 1].node_begin -
                                           model.mesh.first_node,
                                       model.mesh.original.end()) +
                     1;
  for (const int original : split.original) {
    model.node_position.push_back(mesh.nodes[original]);
    model.mesh.original.push_back(first_original + original);
  }
  model.node_mass.resize(model.node_position.size(), 0.0);
  for (int t = 0; t < static_cast<int>(split.tets.size()); ++t) {
    geom::Tet tet = split.tets[t];
    const double volume = tet_volume(mesh, t);
    for (int& node : tet) {
      node += first;
      model.node_mass[node] += density * volume / 4;
    }
    model.tets.push_back(tet);
    model.tet_block.push_back(block);
  }
  model.gravitational_mass.insert(model.gravitational_mass.end(), model.node_mass.begin() + first,
                                  model.node_mass.end());
  const Bonding& bonding = model.bodies[model.blocks[block].body].bonding;
  if (bonding.is_cohesive() && bonding.between_regions && !bonding.everywhere)
    raise_light_corners_of_regions(model, mesh, model.blocks[block]);
}

void add_boundary(Model& model, const std::vector<geom::OuterFace>& outer, int block) {
  const int first_tet = model.blocks[block].tet_begin;
  for (const geom::OuterFace& face : outer) {
    BoundaryTriangle triangle;
    triangle.block = block;
    triangle.tet = first_tet + face.tet;
    for (int i = 0; i < 3; ++i)
      triangle.nodes[i] = model.tets[triangle.tet][geom::tet_faces[face.face][i]];
    const auto& x = model.node_position;
    const geom::Vec3 area =
        0.5 *
        (x[triangle.nodes[1]] - x[triangle.nodes[0]]).cross(x[triangle.nodes[2]] - x[triangle.nodes[0]]);
    OuterFace side;
    side.block = block;
    side.boundary = static_cast<int>(model.mesh.boundary.size());
    side.area = area.norm();
    side.normal = area / side.area;
    model.outer_faces.push_back(std::move(side));
    model.mesh.boundary.push_back(triangle);
  }
}

// One side of a freed face: `face` of BondedFaces seen from its tet, which has the number `place` in MeshData::faces. both: the
// other side is in the same chunk, and stands nowhere else.
struct FaceSide {
  int tet = 0, face = 0, side = 0;
  std::int64_t place = 0;
  bool both = false;
};

// By tet. The faces stand in MeshData in their order, the last batch of each chunk in part.
std::vector<FaceSide> face_sides(const std::vector<BondedFace>& faces, int chunk_tets,
                                 std::int64_t first_batch) {
  std::vector<FaceSide> sides;
  std::int64_t place = first_batch * lanes;
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    if (f > 0 && faces[f].face.tets[0] / chunk_tets != faces[f - 1].face.tets[0] / chunk_tets)
      place = (place + lanes - 1) / lanes * lanes;
    const auto& tets = faces[f].face.tets;
    const bool both = tets[0] / chunk_tets == tets[1] / chunk_tets;
    for (int side = 0; side < (both ? 1 : 2); ++side)
      sides.push_back({tets[side], f, side, place, both});
    ++place;
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const FaceSide& a, const FaceSide& b) { return a.tet < b.tet; });
  return sides;
}

void add_sides(MeshData& data, const std::vector<BondedFace>& faces, const FaceSide* begin, std::size_t count,
               Range chunk_tets, int first_tet, const std::vector<geom::Tet>& tets, Places& places) {
  for (std::size_t first = 0; first < count; first += lanes) {
    FaceSideBatch batch{};
    for (int lane = 0; lane < lanes; ++lane) {
      const bool used = first + lane < count;
      const FaceSide& s = begin[used ? first + lane : first];
      const geom::InnerFace& face = faces[s.face].face;
      for (int i = 0; i < 3; ++i) {
        // The face's corners go round as seen from outside the first tet.
        const int corner = s.side == 0 ? i : 2 - i;
        batch.place[i][lane] = places.of(tets[first_tet + s.tet][face.corners[s.side][corner]]);
        batch.beyond[i][lane] =
            places.of(tets[first_tet + face.tets[1 - s.side]][face.corners[1 - s.side][corner]]);
      }
      batch.tet[lane] = static_cast<std::int32_t>(first_tet + s.tet - chunk_tets.begin);
      batch.beyond_tet[lane] =
          s.both ? static_cast<std::int32_t>(first_tet + face.tets[1 - s.side] - chunk_tets.begin) : -1;
      batch.face[lane] = used ? static_cast<std::int32_t>(s.place) : -1;
    }
    data.sides.push_back(batch);
  }
}

void add_chunks(Model& model, const std::vector<BondedFace>& faces, const std::vector<std::int64_t>& inner,
                int chunk_tets, int block, Places& places) {
  MeshData& data = model.mesh;
  const Block& b = model.blocks[block];
  const std::vector<FaceSide> sides =
      model.bodies[b.body].bonding.is_cohesive()
          ? face_sides(faces, chunk_tets, static_cast<std::int64_t>(data.faces.size()))
          : std::vector<FaceSide>{};
  std::size_t side = 0;
  std::size_t face = 0;
  int node = b.node_begin;
  for (int begin = b.tet_begin; begin < b.tet_end; begin += chunk_tets) {
    MeshChunk chunk;
    chunk.block = block;
    chunk.blocks = {block, block + 1};
    chunk.tets = {begin, std::min(b.tet_end, begin + chunk_tets)};
    chunk.nodes = {node, nodes_end(model.tets, chunk.tets, node)};
    chunk.inner_end = chunk.nodes.begin + inner[(begin - b.tet_begin) / chunk_tets];
    node = static_cast<int>(chunk.nodes.end);
    places.start(chunk.nodes);
    chunk.batches.begin = static_cast<std::int64_t>(data.batches.size());
    add_tets(data, chunk.tets, model.tets, places);
    chunk.batches.end = static_cast<std::int64_t>(data.batches.size());

    std::vector<BondedFace> own;
    for (; face < faces.size() && b.tet_begin + faces[face].face.tets[0] < chunk.tets.end; ++face)
      own.push_back(faces[face]);
    chunk.faces = static_cast<int>(own.size());
    chunk.face_batches.begin = static_cast<std::int64_t>(data.faces.size());
    add_faces(data, own, b.tet_begin, model.tets, places);
    if (has_own_strengths(model))
      add_strengths(data, own);
    chunk.face_batches.end = static_cast<std::int64_t>(data.faces.size());

    const std::size_t first_side = side;
    while (side < sides.size() && b.tet_begin + sides[side].tet < chunk.tets.end)
      ++side;
    chunk.side_batches.begin = static_cast<std::int64_t>(data.sides.size());
    add_sides(data, faces, sides.data() + first_side, side - first_side, chunk.tets, b.tet_begin, model.tets,
              places);
    chunk.side_batches.end = static_cast<std::int64_t>(data.sides.size());

    chunk.others.begin = static_cast<std::int64_t>(data.others.size());
    data.others.insert(data.others.end(), places.others().begin(), places.others().end());
    chunk.others.end = static_cast<std::int64_t>(data.others.size());
    chunk.partial.begin = data.chunks.empty() ? 0 : data.chunks.back().partial.end;
    chunk.partial.end = chunk.partial.begin + chunk.nodes.end - chunk.inner_end + chunk.others.size();
    data.chunks.push_back(chunk);

    BlockChunk step;
    step.blocks = {block, block}; // it owns no whole block
    step.nodes = chunk.nodes;
    model.chunks.push_back(step);
  }
}

void add_star_chunk(Model& model, Range blocks, Places& places) {
  MeshData& data = model.mesh;
  const Block &head = model.blocks[blocks.begin], &last = model.blocks[blocks.end - 1];
  MeshChunk chunk;
  chunk.block = static_cast<int>(blocks.begin);
  chunk.blocks = blocks;
  chunk.stars = true;
  chunk.tets = {head.tet_begin, last.tet_end};
  chunk.nodes = {head.node_begin, last.node_end};
  chunk.inner_end = chunk.nodes.end;
  places.start(chunk.nodes);
  chunk.batches.begin = static_cast<std::int64_t>(data.batches.size());
  add_tets(data, chunk.tets, model.tets, places);
  chunk.batches.end = static_cast<std::int64_t>(data.batches.size());
  chunk.face_batches.begin = chunk.face_batches.end = static_cast<std::int64_t>(data.faces.size());
  chunk.side_batches.begin = chunk.side_batches.end = static_cast<std::int64_t>(data.sides.size());
  chunk.others.begin = chunk.others.end = static_cast<std::int64_t>(data.others.size());
  chunk.partial.begin = chunk.partial.end = data.chunks.empty() ? 0 : data.chunks.back().partial.end;
  data.chunks.push_back(chunk);
  BlockChunk step;
  step.blocks = {blocks.end, blocks.end}; // it owns no block of small strain
  step.nodes = chunk.nodes;
  model.chunks.push_back(step);
}

void add_shares(Model& model) {
  MeshData& data = model.mesh;
  const int first = data.first_node;
  std::vector<int> rank(model.node_position.size() - static_cast<std::size_t>(first),
                        -1); // among shared nodes
  int shared = 0;
  for (MeshChunk& chunk : data.chunks) {
    chunk.share_begin = shared;
    for (std::int64_t node = chunk.inner_end; node < chunk.nodes.end; ++node)
      rank[node - first] = shared++;
  }
  // Visits the partial forces in their order: visit(rank of the node, place).
  const auto each = [&](const auto& visit) {
    for (const MeshChunk& chunk : data.chunks) {
      auto place = static_cast<int>(chunk.partial.begin);
      for (std::int64_t node = chunk.inner_end; node < chunk.nodes.end; ++node)
        visit(rank[node - first], place++);
      for (std::int64_t i = chunk.others.begin; i < chunk.others.end; ++i)
        visit(rank[data.others[i] - first], place++);
    }
  };
  data.share_begin.assign(static_cast<std::size_t>(shared) + 1, 0);
  each([&](int node, int) { ++data.share_begin[node + 1]; });
  std::partial_sum(data.share_begin.begin(), data.share_begin.end(), data.share_begin.begin());
  std::vector<int> next(data.share_begin.begin(), data.share_begin.end() - 1);
  data.shares.resize(data.share_begin.back());
  each([&](int node, int place) { data.shares[next[node]++] = place; });
}

// Adds the laws of the tets of the last block that was added. regions: of its tets; empty: one region.
void add_plastic_laws(Model& model, int block, const std::vector<int>& regions) {
  const Block& b = model.blocks[block];
  const PlasticLaws& laws = model.bodies[b.body].plasticity;
  if (laws.empty())
    return;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    const auto slot = static_cast<std::size_t>(model.mesh.tet_slot[tet - model.mesh.first_tet]);
    if (model.mesh.plastic_law.size() <= slot)
      model.mesh.plastic_law.resize(slot + 1, -1);
    model.mesh.plastic_law[slot] =
        static_cast<std::int8_t>(regions.empty() ? laws.others : laws.of_region(regions[tet - b.tet_begin]));
  }
}

} // namespace

geom::Vec3 face_point(const Model& model, const MeshChunk& chunk, const FaceSpringPlace& at) {
  const FaceNodes nodes = face_nodes(model.mesh, chunk, at.batch, at.lane);
  geom::Vec3 x = geom::Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    x += (i == at.point ? 2.0 / 3 : 1.0 / 6) * model.node_position[nodes.a[i]];
  return x;
}

void start_meshes(Model& model) {
  model.mesh.first_node = static_cast<int>(model.node_position.size());
  model.mesh.first_tet = static_cast<int>(model.tets.size());
}

void add_convex_blocks(Model& model, const std::vector<geom::BlockMesh>& meshes) {
  const auto n_blocks = static_cast<int>(model.blocks.size());
  const auto first = static_cast<int>(
      std::find_if(model.blocks.begin(), model.blocks.end(), [](const Block& b) { return b.meshed; }) -
      model.blocks.begin());
  model.mesh.original.resize(model.node_position.size() - static_cast<std::size_t>(model.mesh.first_node));
  std::iota(model.mesh.original.begin(), model.mesh.original.end(), 0);
  Places places({0, static_cast<std::int64_t>(model.node_position.size())});
  for (int begin = first; begin < n_blocks;) {
    const Block& head = model.blocks[begin];
    int end = begin + 1;
    while (end < n_blocks && model.blocks[end].body == head.body &&
           model.blocks[end].tet_end - head.tet_begin <= tets_per_chunk)
      ++end;
    add_star_chunk(model, {begin, end}, places);
    begin = end;
  }
  for (int b = first; b < n_blocks; ++b)
    add_plastic_laws(model, b, {});
  for (int b = first; b < n_blocks; ++b)
    for (int f = 0; f < static_cast<int>(meshes[b].fans.size()); ++f)
      for (std::size_t i = 0; i < meshes[b].fans[f].size(); ++i) {
        geom::Triangle nodes = meshes[b].fans[f][i];
        for (int& node : nodes)
          node += model.blocks[b].node_begin;
        model.mesh.boundary.push_back({nodes, model.blocks[b].tet_begin + meshes[b].fan_tets[f][i], b, f});
      }
}

void add_meshes(Model& model, std::vector<MeshSeed>&& seeds) {
  for (MeshSeed& seed : seeds) {
    MeshPart part;
    if (!seed.ordered)
      seed.mesh = geom::ordered(seed.mesh);
    const geom::TetMesh& mesh = seed.mesh;
    const std::vector<int> neighbours = geom::face_neighbours(mesh.tets, mesh.nodes.size());
    const std::vector<geom::InnerFace> inner = geom::inner_faces(mesh, neighbours);
    const Body& body = model.bodies[seed.body];
    if (!seed.ordered)
      require_fracture_energy(mesh, inner, body);
    const Splitting splitting{mesh, body.bonding, seed.freed};
    part.mass = geom::mass_properties(mesh);
    part.bonded = bonded_faces(mesh, inner, body, splitting, has_own_strengths(model));
    part.split = split_mesh(mesh, inner, splitting);
    part.outer = geom::outer_faces(mesh, neighbours);
    part.seed = std::move(seed);
    add_part(model, std::move(part));
  }
  end_parts(model);
}

void add_part(Model& model, MeshPart&& part) {
  const MeshSeed& seed = part.seed;
  const geom::TetMesh& mesh = seed.mesh;
  SplitMesh& split = part.split;
  const Body& body = model.bodies[seed.body];
  const int chunk_tets = chunk_size(split, body.bonding);
  const std::vector<std::int64_t> inner_nodes =
      inner_first(split, part.bonded, chunk_tets, body.bonding.is_cohesive());

  const int index = static_cast<int>(model.blocks.size());
  Block block;
  block.id = seed.id ? seed.id : model.next_id++;
  block.body = seed.body;
  block.unit = seed.unit;
  block.meshed = true;
  block.mass = part.mass;
  block.size = block.first_size = std::cbrt(block.mass.volume);
  block.node_begin = static_cast<int>(model.node_position.size());
  block.node_end = block.node_begin + static_cast<int>(split.original.size());
  block.tet_begin = static_cast<int>(model.tets.size());
  block.tet_end = block.tet_begin + static_cast<int>(mesh.tets.size());
  model.blocks.push_back(std::move(block));
  add_nodes(model, mesh, split, index);
  MeshData& data = model.mesh;
  data.region.resize(static_cast<std::size_t>(model.blocks.back().tet_begin - data.first_tet), 0);
  data.region.insert(data.region.end(), mesh.region.begin(), mesh.region.end());
  data.region.resize(static_cast<std::size_t>(model.blocks.back().tet_end - data.first_tet), 0);
  if (std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const Body& b) { return b.bonding.is_cohesive(); })) {
    data.freed.resize(model.node_position.size() - static_cast<std::size_t>(data.first_node), 0);
    if (!seed.freed.empty())
      for (std::size_t i = 0; i < split.original.size(); ++i)
        data.freed[static_cast<std::size_t>(model.blocks.back().node_begin - data.first_node) + i] =
            seed.freed[split.original[i]];
  }
  for (const auto& [name, faces] : mesh.named)
    for (const int face : faces)
      data.named[{seed.body, name}].push_back(static_cast<int>(data.boundary.size()) + face);
  add_boundary(model, part.outer, index);
  Places places({model.blocks.back().node_begin, static_cast<std::int64_t>(model.node_position.size())});
  add_chunks(model, part.bonded, inner_nodes, chunk_tets, index, places);
  add_plastic_laws(model, index, mesh.region);
}

void end_parts(Model& model) {
  if (!model.mesh.plastic_law.empty())
    model.mesh.plastic_law.resize(model.mesh.batches.size() * lanes, -1);
  add_shares(model);
}

} // namespace cdem
