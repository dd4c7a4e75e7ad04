// Whether the meshes of a Model that was read are whole: chunks, batches, faces, sides, regions, boundary.
#include "libcdem/checkpoint/whole/checks.hpp"

namespace cdem::whole {
namespace {

void check_mesh_chunk(const Model& model, const MeshChunk& chunk) {
  const MeshData& mesh = model.mesh;
  within("mesh.chunks.blocks", chunk.blocks, model.blocks.size());
  require(chunk.blocks.size() > 0 && chunk.block == chunk.blocks.begin, "mesh.chunks.block", chunk.block);
  for (std::int64_t b = chunk.blocks.begin; b < chunk.blocks.end; ++b)
    require(model.blocks[b].meshed && model.blocks[b].body == model.blocks[chunk.block].body,
            "mesh.chunks.blocks", b);
  const Block &first = model.blocks[chunk.blocks.begin], &last = model.blocks[chunk.blocks.end - 1];
  require(chunk.nodes.begin >= first.node_begin && chunk.nodes.end <= last.node_end, "mesh.chunks.nodes",
          chunk.nodes.begin);
  require(chunk.tets.begin >= first.tet_begin && chunk.tets.end <= last.tet_end, "mesh.chunks.tets",
          chunk.tets.begin);
  if (chunk.stars)
    require(chunk.nodes.begin == first.node_begin && chunk.nodes.end == last.node_end &&
                chunk.tets.begin == first.tet_begin && chunk.tets.end == last.tet_end &&
                chunk.inner_end == chunk.nodes.end && chunk.others.size() == 0,
            "mesh.chunks.stars", chunk.blocks.begin);
  require(chunk.inner_end >= chunk.nodes.begin && chunk.inner_end <= chunk.nodes.end, "mesh.chunks.inner_end",
          chunk.inner_end);
  require(chunk.partial.size() == chunk.nodes.end - chunk.inner_end + chunk.others.size(),
          "mesh.chunks.partial", chunk.partial.end);
  require(chunk.batches.size() == (chunk.tets.size() + lanes - 1) / lanes, "mesh.chunks.batches",
          chunk.batches.end);
  require(chunk.tets.size() > 0, "mesh.chunks.tets", chunk.tets.end);
  require(chunk.faces >= 0 && chunk.face_batches.size() == (chunk.faces + lanes - 1) / lanes,
          "mesh.chunks.faces", chunk.faces);
  const std::int64_t shared = chunk.nodes.end - chunk.inner_end;
  within("mesh.chunks.share_begin", chunk.share_begin, chunk.share_begin + shared,
         mesh.share_begin.size() - 1);
  const auto places = static_cast<std::size_t>(chunk.places());
  for (std::int64_t i = chunk.batches.begin; i < chunk.batches.end; ++i)
    for (const auto& corner : mesh.batches[i].place)
      all_below("mesh.batches.place", corner, places);
  const auto laws = model.bodies[model.blocks[chunk.block].body].region_laws.joints.size();
  for (std::int64_t i = chunk.face_batches.begin; i < chunk.face_batches.end && !mesh.strength.empty(); ++i)
    for (const int law : mesh.strength[static_cast<std::size_t>(i)].joint)
      below("mesh.strength.joint", law, laws, -1);
  for (std::int64_t i = chunk.face_batches.begin; i < chunk.face_batches.end; ++i)
    for (int corner = 0; corner < 3; ++corner) {
      all_below("mesh.faces.place", mesh.faces[i].place_a[corner], places);
      all_below("mesh.faces.place", mesh.faces[i].place_b[corner], places);
    }
}

void check_sides(const Model& model, const MeshChunk& chunk) {
  const MeshData& mesh = model.mesh;
  const auto places = static_cast<std::size_t>(chunk.places());
  for (std::int64_t i = chunk.side_batches.begin; i < chunk.side_batches.end; ++i) {
    const FaceSideBatch& sides = mesh.sides[i];
    all_below("mesh.sides.tet", sides.tet, static_cast<std::size_t>(chunk.tets.size()));
    all_below("mesh.sides.beyond_tet", sides.beyond_tet, static_cast<std::size_t>(chunk.tets.size()), -1);
    all_below("mesh.sides.face", sides.face, mesh.faces.size() * lanes, -1);
    for (int corner = 0; corner < 3; ++corner) {
      all_below("mesh.sides.place", sides.place[corner], places);
      all_below("mesh.sides.place", sides.beyond[corner], places);
    }
  }
}

// Each tet of a plastic body has a law of its body.
void check_plastic(const Model& model) {
  const MeshData& mesh = model.mesh;
  const auto is_plastic = [](const Body& body) { return !body.plasticity.empty(); };
  // A body of which all was removed has no tets left.
  const bool any = std::any_of(model.blocks.begin(), model.blocks.end(),
                               [&](const Block& block) { return is_plastic(model.bodies[block.body]); });
  require_length("mesh.plastic_law", mesh.plastic_law.size(), any ? mesh.batches.size() * lanes : 0);
  std::int64_t tets = 0; // with a law: no other lane may have one
  for (int tet = mesh.first_tet; any && tet < static_cast<int>(model.tets.size()); ++tet) {
    const std::int8_t law = mesh.plastic_law[mesh.tet_slot[tet - mesh.first_tet]];
    below("mesh.plastic_law", law,
          model.bodies[model.blocks[model.tet_block[tet]].body].plasticity.laws.size(), -1);
    tets += law >= 0 ? 1 : 0;
  }
  require(std::count_if(mesh.plastic_law.begin(), mesh.plastic_law.end(),
                        [](std::int8_t law) { return law >= 0; }) == tets,
          "mesh.plastic_law", tets);
}

// A mesh with cohesive faces or laws of regions has a region for each tet, the first a mark for each node.
void check_cohesive(const Model& model) {
  const MeshData& mesh = model.mesh;
  for (const Block& block : model.blocks) {
    const Body& body = model.bodies[block.body];
    const bool cohesive = body.bonding.is_cohesive();
    if (block.meshed && (cohesive || !body.region_laws.empty()))
      require(block.tet_end - mesh.first_tet <= count(mesh.region.size()), "mesh.region",
              count(mesh.region.size()));
    if (block.meshed && cohesive)
      require(block.node_end - mesh.first_node <= count(mesh.freed.size()), "mesh.freed",
              count(mesh.freed.size()));
  }
  require(mesh.region.size() <= mesh.tet_slot.size(), "mesh.region", count(mesh.region.size()));
  require(mesh.freed.size() <= mesh.original.size(), "mesh.freed", count(mesh.freed.size()));
  all_below("mesh.original", mesh.original, mesh.original.size());
}

} // namespace

void check_mesh(const Model& model) {
  const MeshData& mesh = model.mesh;
  const std::size_t nodes = model.node_position.size(), tets = model.tets.size();
  below("mesh.first_node", mesh.first_node, nodes + 1);
  below("mesh.first_tet", mesh.first_tet, tets + 1);
  const std::size_t own_tets = tets - static_cast<std::size_t>(mesh.first_tet);
  const std::size_t slots = mesh.batches.size() * lanes, faces = mesh.faces.size() * lanes;
  require_length("mesh.face_tets", mesh.face_tets.size(), faces);
  require_length("mesh.strength", mesh.strength.size(), mesh.strength.empty() ? 0 : mesh.faces.size());
  for (const FaceTets& face : mesh.face_tets) {
    below("mesh.face_tets", face.tet_a, tets, -1);
    below("mesh.face_tets", face.tet_b, tets, -1);
  }
  all_below("mesh.others", mesh.others, nodes);
  require_length("mesh.original", mesh.original.size(), nodes - static_cast<std::size_t>(mesh.first_node));
  require_length("mesh.tet_slot", mesh.tet_slot.size(), own_tets);
  all_below("mesh.tet_slot", mesh.tet_slot, slots);
  if (mesh.share_begin.empty()) {
    require_length("mesh.chunks", mesh.chunks.size(), 0);
    require_length("mesh.shares", mesh.shares.size(), 0);
  } else {
    require_parts("mesh.share_begin", mesh.share_begin, mesh.share_begin.size() - 1, mesh.shares.size());
  }
  Follow chunk_nodes("mesh.chunks.nodes", mesh.first_node), chunk_tets("mesh.chunks.tets", mesh.first_tet),
      batches("mesh.chunks.batches", 0), face_batches("mesh.chunks.face_batches", 0),
      others("mesh.chunks.others", 0), sides("mesh.chunks.side_batches", 0),
      partial("mesh.chunks.partial", 0);
  for (const MeshChunk& chunk : mesh.chunks) {
    chunk_nodes(chunk.nodes);
    chunk_tets(chunk.tets);
    batches(chunk.batches);
    face_batches(chunk.face_batches);
    others(chunk.others);
    sides(chunk.side_batches);
    within("mesh.chunks.side_batches", chunk.side_batches, mesh.sides.size());
    check_sides(model, chunk);
    partial(chunk.partial);
    within("mesh.chunks.batches", chunk.batches, mesh.batches.size());
    within("mesh.chunks.face_batches", chunk.face_batches, mesh.faces.size());
    within("mesh.chunks.others", chunk.others, mesh.others.size());
    check_mesh_chunk(model, chunk);
    for (std::int64_t f = 0; f < chunk.faces; ++f) {
      const FaceTets& pair = mesh.face_tets[static_cast<std::size_t>(chunk.face_batches.begin * lanes + f)];
      require(pair.tet_a >= mesh.first_tet && pair.tet_b >= mesh.first_tet, "mesh.face_tets", pair.tet_a);
    }
  }
  chunk_nodes.end_at(count(nodes));
  chunk_tets.end_at(count(tets));
  batches.end_at(count(mesh.batches.size()));
  face_batches.end_at(count(mesh.faces.size()));
  others.end_at(count(mesh.others.size()));
  sides.end_at(count(mesh.sides.size()));
  check_cohesive(model);
  check_plastic(model);
  all_below("mesh.shares", mesh.shares,
            mesh.chunks.empty() ? 0 : static_cast<std::size_t>(mesh.chunks.back().partial.end));
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const BoundaryTriangle& triangle = mesh.boundary[i];
    below("mesh.boundary.block", triangle.block, model.blocks.size());
    const Block& block = model.blocks[triangle.block];
    for (const int node : triangle.nodes)
      require(node >= block.node_begin && node < block.node_end, "mesh.boundary.nodes", node);
    require(triangle.tet >= block.tet_begin && triangle.tet < block.tet_end, "mesh.boundary.tet",
            triangle.tet);
    below("mesh.boundary.face", triangle.face, block.shape.faces.size(), -1);
    require(i == 0 || mesh.boundary[i - 1].block <= triangle.block, "mesh.boundary.block", triangle.block);
  }
}

} // namespace cdem::whole
