#include "libcdem/checkpoint/require_whole.hpp"

#include "libcdem/checkpoint/whole/checks.hpp"

namespace cdem {

using namespace whole;

namespace {

void check_shape(const geom::Polyhedron& shape) {
  for (const geom::PolyhedronFace& face : shape.faces) {
    require(face.loop.size() >= 3, "blocks.shape", count(face.loop.size()));
    all_below("blocks.shape", face.loop, shape.vertices.size());
  }
}

void check_blocks(const Model& model) {
  Follow nodes("blocks.nodes", 0), tets("blocks.tets", 0);
  for (const Block& block : model.blocks) {
    below("blocks.body", block.body, model.bodies.size());
    require(block.unit >= 1 && block.unit <= model.bodies[block.body].units, "blocks.unit", block.unit);
    check_shape(block.shape);
    nodes(block.node_begin, block.node_end);
    tets(block.tet_begin, block.tet_end);
    require(block.node_end > block.node_begin && block.tet_end > block.tet_begin, "blocks.nodes",
            block.node_end);
    const std::int64_t own = block.node_end - block.node_begin, corners = count(block.shape.vertices.size()),
                       faces = count(block.shape.faces.size());
    if (block.convex())
      require(block.star() ? own == corners + faces + 1 : own >= corners, "blocks.nodes", own);
    require(block.convex() || block.meshed, "blocks.meshed", block.meshed);
    const bool in_mesh = block.node_begin >= model.mesh.first_node && block.tet_begin >= model.mesh.first_tet;
    require(in_mesh == block.meshed, "blocks.meshed", block.meshed);
    below("blocks.rigid", block.rigid, model.rigid.size(), -1);
    require(block.rigid < 0 || block.meshed, "blocks.rigid", block.rigid);
    for (int t = block.tet_begin; t < block.tet_end && t < static_cast<int>(model.tets.size()); ++t)
      for (const int node : model.tets[t])
        require(node >= block.node_begin && node < block.node_end, "tets", node);
  }
  nodes.end_at(count(model.node_position.size()));
  tets.end_at(count(model.tets.size()));
  for (std::size_t r = 0; r < model.rigid.size(); ++r) {
    below("rigid.block", model.rigid[r].block, model.blocks.size());
    require(model.blocks[model.rigid[r].block].rigid == static_cast<int>(r), "rigid.block",
            model.rigid[r].block);
    require(r == 0 || model.rigid[r - 1].block < model.rigid[r].block, "rigid.block", model.rigid[r].block);
  }
  const auto rigid =
      std::count_if(model.blocks.begin(), model.blocks.end(), [](const Block& b) { return b.rigid >= 0; });
  require_length("rigid", model.rigid.size(), static_cast<std::size_t>(rigid));
}

void check_interfaces(const Model& model) {
  const std::size_t nodes = model.node_position.size(), points = model.points.size();
  for (const Interface& i : model.interfaces) {
    for (const auto& [block, face] : {std::pair(i.block_a, i.face_a), std::pair(i.block_b, i.face_b)}) {
      below("interfaces.block", block, model.blocks.size());
      below("interfaces.face", face, model.blocks[block].shape.faces.size());
    }
    require(i.block_a < i.block_b, "interfaces.block", i.block_b);
    below("interfaces.joint", i.joint, model.joints.size());
    require(i.origin <= InterfaceOrigin::cut, "interfaces.origin", static_cast<int>(i.origin));
    within("interfaces.points", i.point_begin, i.point_end, points);
    within("interfaces.triangles", i.triangle_begin, i.triangle_end, model.bond_triangles.size());
    for (int t = i.triangle_begin; t < i.triangle_end; ++t)
      for (const int point : model.bond_triangles[t])
        require(point >= i.point_begin && point < i.point_end, "bond_triangles", point);
    below("interfaces.frame", i.frame, model.frames.size(), -1);
  }
  for (const InterfaceFrame& frame : model.frames) {
    all_below("frames.nodes", frame.nodes_a, nodes);
    all_below("frames.nodes", frame.nodes_b, nodes);
  }
  for (std::size_t p = 0; p < points; ++p) {
    const BondPoint& point = model.points[p];
    below("points.interface", point.interface, model.interfaces.size());
    const Interface& i = model.interfaces[point.interface];
    require(count(p) >= i.point_begin && count(p) < i.point_end, "points.interface", point.interface);
    const auto of = [&](const std::array<int, 3>& list, const Block& block) {
      for (const int node : list)
        require(node >= block.node_begin && node < block.node_end, "points.node", node);
    };
    of(point.node_a, model.blocks[i.block_a]);
    of(point.node_b, model.blocks[i.block_b]);
  }
  require_length("point_position", model.point_position.size(), points);
  if (!model.point_apart.empty())
    require_length("point_apart", model.point_apart.size(), points);
  for (const geom::Triangle& triangle : model.bond_triangles)
    all_below("bond_triangles", triangle, points);
  require_parts("bond_begin", model.bond_begin, nodes, model.spring_ends.size());
  for (const SpringEnd& spring : model.spring_ends)
    below("spring_ends.point", spring.point(), points);
  Follow parts("point_chunks", 0);
  for (const Range& chunk : model.point_chunks)
    parts(chunk);
  parts.end_at(count(points));
}

void check_chunks(const Model& model) {
  const std::size_t nodes = model.node_position.size();
  Follow chunk_nodes("chunks.nodes", 0), batches("chunks.batches", 0);
  for (const BlockChunk& chunk : model.chunks) {
    within("chunks.blocks", chunk.blocks, model.blocks.size());
    chunk_nodes(chunk.nodes);
    if (chunk.nodes.begin < model.mesh.first_node) {
      require(chunk.blocks.size() > 0, "chunks.blocks", chunk.blocks.begin);
      require(chunk.nodes.begin == model.blocks[chunk.blocks.begin].node_begin &&
                  chunk.nodes.end == model.blocks[chunk.blocks.end - 1].node_end,
              "chunks.nodes", chunk.nodes.begin);
      batches(chunk.batches);
      within("chunks.batches", chunk.batches, model.batches.size());
      for (std::int64_t i = chunk.batches.begin; i < chunk.batches.end; ++i)
        for (const auto& corner : model.batches[i].node)
          for (const int node : corner)
            below("batches.node", node, static_cast<std::size_t>(chunk.nodes.size()));
    } else {
      require(chunk.batches.size() == 0 && chunk.blocks.size() == 0, "chunks.batches", chunk.batches.end);
    }
  }
  chunk_nodes.end_at(count(nodes));
  batches.end_at(count(model.batches.size()));
  std::size_t first = 0;
  while (first < model.chunks.size() && model.chunks[first].nodes.begin < model.mesh.first_node)
    ++first;
  require_length("chunks", model.chunks.size() - first, model.mesh.chunks.size());
  for (std::size_t i = 0; i < model.mesh.chunks.size(); ++i)
    require(model.chunks[first + i].nodes.begin == model.mesh.chunks[i].nodes.begin &&
                model.chunks[first + i].nodes.end == model.mesh.chunks[i].nodes.end,
            "chunks.nodes", model.chunks[first + i].nodes.begin);
}

void check_outer_faces(const Model& model) {
  for (const OuterFace& face : model.outer_faces) {
    below("outer_faces.block", face.block, model.blocks.size());
    const std::size_t faces = model.blocks[face.block].shape.faces.size();
    const bool of_mesh = face.boundary >= 0 && !model.blocks[face.block].convex();
    below("outer_faces.face", face.face, of_mesh ? 1 : faces, of_mesh ? -1 : 0);
    below("outer_faces.boundary", face.boundary, model.mesh.boundary.size(), -1);
    require(face.boundary < 0 || model.mesh.boundary[face.boundary].block == face.block,
            "outer_faces.boundary", face.boundary);
    for (const auto& [node, area] : face.node_area)
      below("outer_faces.node", node, model.node_position.size());
  }
}

} // namespace

void require_whole(const Model& model) {
  require(!model.bodies.empty() && !model.blocks.empty(), "blocks", 0);
  for (const Body& body : model.bodies) {
    require(body.element <= Element::rigid, "bodies.element", static_cast<int>(body.element));
    require(body.bonding.kind <= BondKind::cohesive, "bodies.bonding", static_cast<int>(body.bonding.kind));
    require_length("bodies.region_laws", body.region_laws.regions.size(), body.region_laws.joints.size());
    require_length("bodies.region_laws", body.region_laws.by_regions.size(), body.region_laws.joints.size());
    all_below("bodies.region_laws", body.region_laws.by_regions, body.region_laws.joints.size());
  }
  for (const Body& body : model.bodies) {
    below("bodies.glued_joint", body.glued_joint, model.joints.size(), -1);
    for (const auto& [name, joint] : body.set_joint)
      below("bodies.set_joint", joint, model.joints.size());
  }
  for (const Body& body : model.bodies) {
    below("bodies.plasticity", body.plasticity.others, body.plasticity.laws.size(), -1);
    for (const auto& [region, law] : body.plasticity.regions)
      below("bodies.plasticity", law, body.plasticity.laws.size());
  }
  check_pairs("pair_joint", model.pair_joint, model);
  for (const Joint& joint : model.joints) // a table without rows is read beyond its end
    with_law(joint.law, [](const auto& law) { law.validate(); });
  require_length("gravitational_mass", model.gravitational_mass.size(), model.node_position.size());
  require_length("node_mass", model.node_mass.size(), model.node_position.size());
  require_length("tet_block", model.tet_block.size(), model.tets.size());
  all_below("tet_block", model.tet_block, model.blocks.size());
  check_blocks(model);
  check_interfaces(model);
  check_mesh(model);
  check_surface(model);
  check_chunks(model);
  check_outer_faces(model);
}

} // namespace cdem
