#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {
namespace {

// Where each rank's share of something begins that runs along the chunks of meshes.
template <class Begin>
std::vector<std::int64_t> along_mesh_chunks(const Model& model, const Partition& part, std::int64_t end,
                                            const Begin& begin) {
  std::vector<std::int64_t> at;
  for (const std::int64_t chunk : part.chunk_begin) {
    const std::int64_t c = std::max(chunk, part.stars) - part.stars;
    at.push_back(c < static_cast<std::int64_t>(model.mesh.chunks.size()) ? begin(model.mesh.chunks[c]) : end);
  }
  return at;
}

std::vector<std::size_t> in_bytes(const std::vector<std::int64_t>& begin, std::size_t entry) {
  std::vector<std::size_t> bytes;
  bytes.reserve(begin.size());
  for (const std::int64_t item : begin)
    bytes.push_back(static_cast<std::size_t>(item) * entry);
  return bytes;
}

// Nodes that the chunks and springs of this rank read.
std::vector<std::int32_t> nodes_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> nodes;
  const MeshData& mesh = model.mesh;
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    nodes.insert(nodes.end(), mesh.others.begin() + chunk.others.begin,
                 mesh.others.begin() + chunk.others.end);
    if (chunk.side_batches.size() > 0) // rates of strain on both sides of faces
      for (std::int64_t slot = chunk.face_batches.begin * lanes; slot < chunk.face_batches.end * lanes;
           ++slot)
        for (const int tet : {mesh.face_tets[slot].tet_a, mesh.face_tets[slot].tet_b})
          if (tet >= 0)
            nodes.insert(nodes.end(), model.tets[tet].begin(), model.tets[tet].end());
  }
  const Range points = part.point_chunks();
  for (std::int64_t c = points.begin; c < points.end; ++c)
    for (std::int64_t p = model.point_chunks[c].begin; p < model.point_chunks[c].end; ++p) {
      const BondPoint& point = model.points[p];
      nodes.insert(nodes.end(), point.node_a.begin(), point.node_a.end());
      nodes.insert(nodes.end(), point.node_b.begin(), point.node_b.end());
      if (const int frame = model.interfaces[point.interface].frame; frame >= 0) {
        const InterfaceFrame& at = model.frames[frame];
        nodes.insert(nodes.end(), at.nodes_a.begin(), at.nodes_a.end());
        nodes.insert(nodes.end(), at.nodes_b.begin(), at.nodes_b.end());
      }
    }
  return nodes;
}

std::vector<std::int32_t> springs_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> springs;
  if (model.points.empty())
    return springs;
  const auto take = [&](std::int64_t first, std::int64_t end) { // nodes
    for (std::int64_t i = model.bond_begin[first]; i < model.bond_begin[end]; ++i)
      springs.push_back(model.spring_ends[i].point());
  };
  take(part.nodes().begin, part.nodes().end);
  for (const RigidBody& body : model.rigid) // all ranks move all of them
    take(model.blocks[body.block].node_begin, model.blocks[body.block].node_end);
  return springs;
}

// Places in the slices of all chunks that add up to the nodes it owns.
std::vector<std::int32_t> partial_forces_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> places;
  const MeshData& mesh = model.mesh;
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    if (chunk.stars || chunk.inner_end == chunk.nodes.end)
      continue;
    const int* const begin = mesh.share_begin.data() + chunk.share_begin;
    for (int i = begin[0]; i < begin[chunk.nodes.end - chunk.inner_end]; ++i)
      places.push_back(mesh.shares[i]);
  }
  return places;
}

bool is_cohesive(const Model& model, const MeshChunk& chunk) {
  return model.bodies[model.blocks[chunk.block].body].bonding.is_cohesive();
}

// Batches of tets beyond the faces of its own, in cohesive bodies.
std::vector<std::int32_t> stress_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> batches;
  const MeshData& mesh = model.mesh;
  if (std::none_of(mesh.chunks.begin(), mesh.chunks.end(),
                   [&](const MeshChunk& chunk) { return is_cohesive(model, chunk); }))
    return batches;
  const std::vector<int> neighbours = mesh_neighbours(model);
  const auto take = [&](int tet_of_mesh) { batches.push_back(mesh.tet_slot[tet_of_mesh] / lanes); };
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    if (!is_cohesive(model, chunk))
      continue;
    for (std::int64_t face = 4 * (chunk.tets.begin - mesh.first_tet);
         face < 4 * (chunk.tets.end - mesh.first_tet); ++face)
      if (neighbours[face] >= 0)
        take(neighbours[face] / 4);
    for (std::int64_t slot = chunk.face_batches.begin * lanes; slot < chunk.face_batches.end * lanes; ++slot)
      for (const int tet : {mesh.face_tets[slot].tet_a, mesh.face_tets[slot].tet_b})
        if (tet >= 0)
          take(tet - mesh.first_tet);
  }
  return batches;
}

std::vector<std::int32_t> faces_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> batches;
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const Range sides = model.mesh.chunks[c].side_batches;
    for (std::int64_t b = sides.begin; b < sides.end; ++b)
      for (const std::int32_t face : model.mesh.sides[b].face)
        if (face >= 0)
          batches.push_back(face / lanes);
  }
  return batches;
}

} // namespace

SharedState::SharedState(const Model& model, const std::vector<std::int32_t>& read_always)
    : part_(model, ranks().rank(), ranks().size()), nodes_(nodes_read(model, part_)) {
  nodes_.insert(nodes_.end(), read_always.begin(), read_always.end());
  for (const std::int64_t chunk : part_.point_begin)
    point_begin_.push_back(chunk < static_cast<std::int64_t>(model.point_chunks.size())
                               ? model.point_chunks[chunk].begin
                               : static_cast<std::int64_t>(model.points.size()));
  const MeshData& mesh = model.mesh;
  batch_begin_ = along_mesh_chunks(model, part_, static_cast<std::int64_t>(mesh.batches.size()),
                                   [](const MeshChunk& chunk) { return chunk.batches.begin; });
  face_begin_ = along_mesh_chunks(model, part_, static_cast<std::int64_t>(mesh.faces.size()),
                                  [](const MeshChunk& chunk) { return chunk.face_batches.begin; });
  const auto along = [](const std::vector<std::int64_t>& begin) {
    return [&begin](std::int64_t entry) { return Partition::owner(begin, entry); };
  };
  springs_.set(springs_read(model, part_), along(point_begin_));
  const std::vector<std::int64_t> partial_begin =
      along_mesh_chunks(model, part_, mesh.chunks.empty() ? 0 : mesh.chunks.back().partial.end,
                        [](const MeshChunk& chunk) { return chunk.partial.begin; });
  partial_.set(partial_forces_read(model, part_), along(partial_begin));
  stress_.set(stress_read(model, part_), along(batch_begin_));
  faces_.set(faces_read(model, part_), along(face_begin_));
  set_further_nodes({});
}

void SharedState::set_further_nodes(std::vector<std::int32_t> nodes) {
  nodes.insert(nodes.end(), nodes_.begin(), nodes_.end());
  moved_.set(std::move(nodes), [&](std::int64_t node) { return part_.owner_of_node(node); });
}

void SharedState::share_springs(std::vector<geom::Vec3>& spring_force,
                                std::vector<geom::Vec3>& acting_force) {
  if (acting_force.empty())
    springs_.share({Links::array(spring_force)});
  else
    springs_.share({Links::array(spring_force), Links::array(acting_force)});
}

void SharedState::share_partial_forces(std::vector<geom::Vec3>& partial) {
  partial_.share({Links::array(partial)});
}

void SharedState::share_faces(State& state) {
  faces_.share({Links::array(state.faces)});
}

void SharedState::share_nodes(State& state) {
  moved_.share({Links::array(state.displacement), Links::array(state.velocity)});
  stress_.share({Links::array(state.stress)});
}

std::vector<std::size_t> SharedState::bytes_by_node(std::size_t entry) const {
  return in_bytes(part_.node_begin, entry);
}

std::vector<std::size_t> SharedState::bytes_by_point(std::size_t entry) const {
  return in_bytes(point_begin_, entry);
}

void SharedState::gather_points(std::vector<geom::Vec3>& values) const {
  if (!values.empty())
    ranks().share(values.data(), bytes_by_point(sizeof values[0]));
}

void SharedState::gather_nodes(std::vector<Node>& values) const {
  if (!values.empty())
    ranks().share(values.data(), bytes_by_node(sizeof values[0]));
}

void SharedState::gather(State& state) {
  if (whole_)
    return;
  const auto by_node = [&](auto& values) {
    if (!values.empty())
      ranks().share(values.data(), bytes_by_node(sizeof values[0]));
  };
  const auto by_point = [&](auto& values) {
    if (!values.empty())
      ranks().share(values.data(), bytes_by_point(sizeof values[0]));
  };
  const auto along = [&](const std::vector<std::int64_t>& begin, auto& values, std::size_t entries = 1) {
    if (!values.empty())
      ranks().share(values.data(), in_bytes(begin, entries * sizeof values[0]));
  };
  by_node(state.displacement);
  by_node(state.velocity);
  by_point(state.bond_offset);
  by_point(state.bond_mode);
  by_point(state.bond_damage);
  by_point(state.bond_slip);
  by_point(state.joint_history);
  along(batch_begin_, state.stress);
  along(batch_begin_, state.viscous_stress);
  along(batch_begin_, state.plastic_strain);
  along(face_begin_, state.faces);
  along(face_begin_, state.cohesive, lanes);
  along(face_begin_, state.rate_factor, lanes);
  gather_slips(state);
  whole_ = true;
}

// They stand in the order in which faces broke, the same for all; their faces say whose they are.
void SharedState::gather_slips(State& state) const {
  if (state.face_slip.empty())
    return;
  constexpr std::size_t bytes = lanes * sizeof(FaceSlip);
  const auto each = [&](int rank, const auto& visit) {
    for (std::int64_t b = face_begin_[rank]; b < face_begin_[rank + 1]; ++b)
      if (const std::int32_t first = state.faces[b].slip; first >= 0)
        visit(&state.face_slip[first]);
  };
  std::string own;
  each(part_.rank, [&](const FaceSlip* slips) { own.append(reinterpret_cast<const char*>(slips), bytes); });
  const std::vector<std::string> all = ranks().gather(own);
  for (int r = 0; r < part_.size; ++r) {
    if (r == part_.rank)
      continue;
    const char* from = all[r].data();
    each(r, [&](FaceSlip* slips) {
      std::memcpy(reinterpret_cast<char*>(slips), from, bytes);
      from += bytes;
    });
  }
}

} // namespace cdem
