#include "libcdem/checkpoint/require_whole.hpp"

#include "libcdem/results/cracks.hpp"
#include "libcdem/state/state.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cdem {
namespace {

[[noreturn]] void refuse(const std::string& field, const std::string& what) {
  throw geom::InputError("the saved model is not whole: " + field + ": " + what +
                         "; the file was changed, or written by another version of cdem");
}

void require_length(const std::string& field, std::size_t length, std::size_t wanted) {
  if (length != wanted)
    refuse(field, std::to_string(length) + " entries where there must be " + std::to_string(wanted));
}

void require(bool holds, const char* field, std::int64_t value) {
  if (!holds)
    refuse(field, std::to_string(value) + " is out of range");
}

// 0 <= index < end; from -1 where none is meant by that.
void below(const char* field, std::int64_t index, std::size_t end, std::int64_t first = 0) {
  require(index >= first && index < static_cast<std::int64_t>(end), field, index);
}

template <class List>
void all_below(const char* field, const List& list, std::size_t end, std::int64_t first = 0) {
  for (const auto index : list)
    below(field, index, end, first);
}

// begin <= end within an array of `length` entries.
void within(const char* field, std::int64_t begin, std::int64_t end, std::size_t length) {
  require(begin >= 0 && begin <= end, field, begin);
  require(end <= static_cast<std::int64_t>(length), field, end);
}
void within(const char* field, const Range& range, std::size_t length) {
  within(field, range.begin, range.end, length);
}

// Starts at 0, never falls, ends at `last`: (n + 1) entries that part an array.
template <class List>
void require_parts(const char* field, const List& begin, std::size_t parts, std::size_t last) {
  require_length(field, begin.size(), parts + 1);
  require(begin.front() == 0, field, begin.front());
  require(std::is_sorted(begin.begin(), begin.end()), field, begin.front());
  require(static_cast<std::size_t>(begin.back()) == last, field, begin.back());
}

// Ranges that follow each other from `first` to `last` without a gap.
class Follow {
public:
  Follow(const char* field, std::int64_t first) : field_(field), next_(first) {}
  void operator()(std::int64_t begin, std::int64_t end) {
    require(begin == next_ && end >= begin, field_, begin);
    next_ = end;
  }
  void operator()(const Range& range) { (*this)(range.begin, range.end); }
  void end_at(std::int64_t last) const { require(next_ == last, field_, next_); }

private:
  const char* field_;
  std::int64_t next_;
};

std::int64_t count(std::size_t n) {
  return static_cast<std::int64_t>(n);
}

template <class Pairs>
void check_pairs(const char* field, const Pairs& pairs, const Model& model) {
  for (const auto& [bodies, joint] : pairs) {
    below(field, bodies.first, model.bodies.size());
    below(field, bodies.second, model.bodies.size());
    below(field, joint, model.joints.size());
  }
}

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
  require_parts("bond_begin", model.bond_begin, nodes, model.bonds_on_nodes.size());
  for (const BondOnNode& bond : model.bonds_on_nodes)
    below("bonds_on_nodes.point", bond.point, points);
  Follow parts("point_chunks", 0);
  for (const Range& chunk : model.point_chunks)
    parts(chunk);
  parts.end_at(count(points));
}

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
    all_below("mesh.sides.face", sides.face, mesh.faces.size() * lanes, -1);
    for (int corner = 0; corner < 3; ++corner) {
      all_below("mesh.sides.place", sides.place[corner], places);
      all_below("mesh.sides.place", sides.beyond[corner], places);
    }
  }
}

// Of plastic bodies each tet has a law of its body.
void check_plastic(const Model& model) {
  const MeshData& mesh = model.mesh;
  const auto is_plastic = [](const Body& body) { return !body.plasticity.empty(); };
  const bool any = std::any_of(model.bodies.begin(), model.bodies.end(), is_plastic);
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

// Of cohesive bodies there is a region for each tet and a mark for each node.
void check_cohesive(const Model& model) {
  const MeshData& mesh = model.mesh;
  for (const Block& block : model.blocks)
    if (block.meshed && model.bodies[block.body].bonding.is_cohesive()) {
      require(block.tet_end - mesh.first_tet <= count(mesh.region.size()), "mesh.region",
              count(mesh.region.size()));
      require(block.node_end - mesh.first_node <= count(mesh.freed.size()), "mesh.freed",
              count(mesh.freed.size()));
    }
  require(mesh.region.size() <= mesh.tet_slot.size(), "mesh.region", count(mesh.region.size()));
  require(mesh.freed.size() <= mesh.original.size(), "mesh.freed", count(mesh.freed.size()));
  all_below("mesh.original", mesh.original, mesh.original.size());
}

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

void check_surface(const Model& model) {
  const ContactSurface& surface = model.surface;
  const std::size_t triangles = surface.triangles.size(), nodes = model.node_position.size();
  check_pairs("surface.joint", surface.joint, model);
  for (const auto& [joint, left] : surface.left_by) {
    below("surface.left_by", joint, model.joints.size());
    below("surface.left_by", left, model.joints.size());
  }
  for (const BlockPairLaw& pair : surface.pairs) {
    all_below("surface.pairs", pair.blocks, model.blocks.size());
    below("surface.pairs", pair.joint, model.joints.size());
  }
  if (surface.empty()) {
    require_length("surface.edges", surface.edges.size(), 0);
    return;
  }
  require_parts("surface.block_begin", surface.block_begin, model.blocks.size(), triangles);
  require_length("surface.usual_height", surface.usual_height.size(), model.blocks.size());
  require_length("surface.original", surface.original.size(), nodes);
  for (std::size_t t = 0; t < triangles; ++t) {
    const ContactTriangle& triangle = surface.triangles[t];
    all_below("surface.triangles.nodes", triangle.nodes, nodes);
    below("surface.triangles.block", triangle.block, model.blocks.size());
    require(count(t) >= surface.block_begin[triangle.block] &&
                count(t) < surface.block_begin[triangle.block + 1],
            "surface.triangles.block", triangle.block);
    require(triangle.tet >= model.mesh.first_tet && triangle.tet < count(model.tets.size()),
            "surface.triangles.tet", triangle.tet);
    below("surface.triangles.face", triangle.face, model.mesh.faces.size() * lanes, -1);
    below("surface.triangles.mate", triangle.mate, triangles, -1);
  }
  for (const ContactEdge& edge : surface.edges) {
    all_below("surface.edges.nodes", edge.nodes, nodes);
    all_below("surface.edges.triangles", edge.triangles, triangles);
    below("surface.edges.corner", edge.corner, 3);
  }
  require(std::is_sorted(surface.edges.begin(), surface.edges.end(),
                         [](const ContactEdge& a, const ContactEdge& b) { return a.id() < b.id(); }),
          "surface.edges", 0);
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
            require(node >= chunk.nodes.begin && node < chunk.nodes.end, "batches.node", node);
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

bool is_support_quantity(const Model& model, const Probe& probe) {
  const bool axis =
      probe.crack.size() > 2 && probe.crack.find_first_of("xyz", probe.crack.size() - 1) != std::string::npos;
  const std::string quantity = axis ? probe.crack.substr(0, probe.crack.size() - 2) : "";
  const auto named = [&](const Body& body) { return body.name == probe.on; };
  const bool side = probe.on.size() == 2 && probe.on[0] >= 'x' && probe.on[0] <= 'z' &&
                    (probe.on[1] == '-' || probe.on[1] == '+');
  const bool body = std::any_of(model.bodies.begin(), model.bodies.end(), named);
  return (quantity == "reaction" && (side || body)) || (quantity == "momentum" && body && probe.body >= 0);
}

} // namespace

void require_whole(const Model& model) {
  require(!model.bodies.empty() && !model.blocks.empty(), "blocks", 0);
  for (const Body& body : model.bodies) {
    require(body.element <= Element::rigid, "bodies.element", static_cast<int>(body.element));
    require(body.bonding.kind <= BondKind::cohesive, "bodies.bonding", static_cast<int>(body.bonding.kind));
    require_length("bodies.region_laws", body.region_laws.regions.size(), body.region_laws.joints.size());
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

void require_whole(const Model& model, const RunLog& log) {
  for (const BreakRow& row : log.breaks)
    require(row.mode == BondMode::broken_tension || row.mode == BondMode::broken_shear, "breaks.mode",
            static_cast<int>(row.mode));
  for (const Probe& probe : log.probes)
    if (!probe.crack.empty() || !probe.on.empty()) {
      const auto& known = crack_quantities();
      require(probe.on.empty() ? std::find(known.begin(), known.end(), probe.crack) != known.end()
                               : is_support_quantity(model, probe),
              "probes.crack", 0);
      require(probe.body >= -1 && probe.body < count(model.bodies.size()), "probes.body", probe.body);
    }
  for (const HistoryRow& row : log.history)
    require(row.probes.size() <= log.probes.size(), "history.probes", count(row.probes.size()));
  for (const Watch& watch : log.watches) {
    all_below("watches.blocks", watch.blocks, model.blocks.size());
    require_length("watches.touched", watch.touched.size(), watch.blocks.size());
    for (const auto& touched : watch.touched)
      all_below("watches.touched", touched, model.blocks.size());
    require_length("watches.start", watch.start.size(), model.blocks.size());
    require_length("watches.gone", watch.gone.size(), model.blocks.size());
    std::size_t tets = 0; // of units that can break
    for (const int block : watch.blocks)
      if (!model.bodies[model.blocks[block].body].bonding.none())
        tets += static_cast<std::size_t>(model.blocks[block].tet_end - model.blocks[block].tet_begin);
    require_length("watches.tet_start", watch.tet_start.size(), tets);
    require_length("watches.tet_left", watch.tet_left.size(), tets);
    for (const Departure& departure : watch.left)
      require(departure.unit >= 1 && departure.unit <= count(watch.blocks.size()), "watches.left",
              departure.unit);
  }
  for (const auto& pair : log.unmet)
    all_below("unmet", pair, model.bodies.size());
  require(log.every >= 1, "every", log.every);
}

void require_whole(const Model& model, const RunLog& log, const RestartPoint& point) {
  const auto length = [](const char* field, std::size_t size, std::size_t wanted) {
    if (size != 0)
      require_length(field, size, wanted);
  };
  require(point.step >= 0, "restart.step", point.step);
  require(point.breaks <= log.breaks.size(), "restart.breaks", count(point.breaks));
  if (!(point.contact_step >= 0 && point.contact_step < std::numeric_limits<double>::infinity()))
    refuse("restart.contact_step", std::to_string(point.contact_step) + " is out of range");
  length("restart.previous_force", point.previous_force.size(), model.node_position.size());
  length("restart.spring_force", point.spring_force.size(), model.points.size());
  length("restart.stretch", point.stretch.size(), model.points.size());
}

} // namespace cdem
