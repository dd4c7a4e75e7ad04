#include "libcdem/ranks/shared_state.hpp"

#include "libcdem/ranks/bytes.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {
namespace {

// Steps without a look at the whole state after which the pages of others are given back: more than between the looks of
// a relaxation.
constexpr std::int64_t release_after = 32;

bool is_cohesive(const Model& model, const MeshChunk& chunk) {
  return model.bodies[model.blocks[chunk.block].body].bonding.is_cohesive();
}

// visit(tet of the mesh) for those beyond the faces of the chunks of this rank in cohesive bodies, freed or not.
template <class Visit>
void each_tet_beyond(const Model& model, const Partition& part, const Visit& visit) {
  const MeshData& mesh = model.mesh;
  if (std::none_of(mesh.chunks.begin(), mesh.chunks.end(),
                   [&](const MeshChunk& chunk) { return is_cohesive(model, chunk); }))
    return;
  const std::vector<int> neighbours = mesh_neighbours(model);
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    if (!is_cohesive(model, chunk))
      continue;
    for (std::int64_t face = 4 * (chunk.tets.begin - mesh.first_tet);
         face < 4 * (chunk.tets.end - mesh.first_tet); ++face)
      if (neighbours[face] >= 0)
        visit(neighbours[face] / 4);
    for (std::int64_t slot = chunk.face_batches.begin * lanes; slot < chunk.face_batches.end * lanes; ++slot)
      for (const int tet : {mesh.face_tets[slot].tet_a, mesh.face_tets[slot].tet_b})
        if (tet >= 0)
          visit(tet - mesh.first_tet);
  }
}

// Nodes that the chunks and springs of this rank read.
std::vector<std::int32_t> nodes_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> nodes;
  const MeshData& mesh = model.mesh;
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    if (is_rigid(model, chunk)) // placed as wholes
      continue;
    nodes.insert(nodes.end(), mesh.others.begin() + chunk.others.begin,
                 mesh.others.begin() + chunk.others.end);
  }
  each_tet_beyond(model, part, [&](int tet) { // rates of strain on both sides of faces
    const geom::Tet& corners = model.tets[mesh.first_tet + tet];
    nodes.insert(nodes.end(), corners.begin(), corners.end());
  });
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
  for (const RigidBody& body : model.rigid)
    if (const Block& block = model.blocks[body.block]; part.owner_of_node(block.node_begin) == part.rank)
      take(block.node_begin, block.node_end);
  return springs;
}

// Places in the slices of all chunks that add up to the nodes it owns.
std::vector<std::int32_t> partial_forces_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> places;
  const MeshData& mesh = model.mesh;
  const Range chunks = part.mesh_chunks();
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    if (chunk.stars || is_rigid(model, chunk) || chunk.inner_end == chunk.nodes.end)
      continue;
    const int* const begin = mesh.share_begin.data() + chunk.share_begin;
    for (int i = begin[0]; i < begin[chunk.nodes.end - chunk.inner_end]; ++i)
      places.push_back(mesh.shares[i]);
  }
  return places;
}

// Batches of tets beyond the faces of its own, in cohesive bodies.
std::vector<std::int32_t> stress_read(const Model& model, const Partition& part) {
  std::vector<std::int32_t> batches;
  each_tet_beyond(model, part, [&](int tet) { batches.push_back(model.mesh.tet_slot[tet] / lanes); });
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

SharedState::SharedState(const Model& model, Partition part)
    : part_(std::move(part)), shares_(std::make_shared<const StateShares>(model, part_)) {
  for (int rigid = 0; rigid < static_cast<int>(model.rigid.size()); ++rigid) {
    const Block& block = model.blocks[model.rigid[rigid].block];
    mover_.push_back(part_.owner_of_node(block.node_begin));
    if (moves(rigid))
      moved_bodies_.push_back(rigid);
    if (block.node_begin < part_.nodes().end && part_.nodes().begin < block.node_end)
      own_bodies_.push_back(rigid);
  }
  placed_bodies_ = own_bodies_;
}

SharedState::SharedState(const Model& model)
    : SharedState(model, Partition(model, std::vector<double>(model.chunks.size()), 0, 1)) {}

SharedState::SharedState(const Model& model, const std::vector<std::int32_t>& read_always,
                         const std::vector<double>& loads)
    : SharedState(model, Partition(model, loads, ranks().rank(), ranks().size())) {
  nodes_ = nodes_read(model, part_);
  nodes_.insert(nodes_.end(), read_always.begin(), read_always.end());
  const MeshData& mesh = model.mesh;
  const auto along = [](const std::vector<std::int64_t>& begin) {
    return [&begin](std::int64_t entry) { return Partition::owner(begin, entry); };
  };
  springs_.set(springs_read(model, part_), along(shares_->point_begin()));
  const std::vector<std::int64_t> partial_begin =
      along_mesh_chunks(model, part_, mesh.chunks.empty() ? 0 : mesh.chunks.back().partial.end,
                        [](const MeshChunk& chunk) { return chunk.partial.begin; });
  partial_.set(partial_forces_read(model, part_), along(partial_begin));
  stress_.set(stress_read(model, part_), along(shares_->batch_begin()));
  faces_.set(faces_read(model, part_), along(shares_->face_begin()));
  set_further_nodes({});
}

void SharedState::set_further_nodes(std::vector<std::int32_t> nodes) {
  nodes.insert(nodes.end(), nodes_.begin(), nodes_.end());
  moved_.set(std::move(nodes), [&](std::int64_t node) { return part_.owner_of_node(node); });
}

void SharedState::set_further_bodies(std::vector<int> rigid) {
  rigid.insert(rigid.end(), own_bodies_.begin(), own_bodies_.end());
  std::sort(rigid.begin(), rigid.end());
  rigid.erase(std::unique(rigid.begin(), rigid.end()), rigid.end());
  placed_bodies_ = std::move(rigid);
}

void SharedState::share_rigid(State& state, std::vector<geom::Vec3>& angle) {
  if (alone())
    return;
  Pack own;
  for (const int rigid : moved_bodies_) {
    own(state.rigid[rigid]);
    own(angle[rigid]);
  }
  const std::vector<std::string> heard = ranks().gather(own.text(), Ranks::Subject::rigid);
  std::vector<Unpack> of_rank(heard.begin(), heard.end());
  for (int rigid = 0; rigid < static_cast<int>(mover_.size()); ++rigid)
    if (!moves(rigid)) {
      of_rank[mover_[rigid]](state.rigid[rigid]);
      of_rank[mover_[rigid]](angle[rigid]);
    }
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
  if (state.moving_mass.empty())
    moved_.share({Links::array(state.displacement), Links::array(state.velocity)});
  else
    moved_.share(
        {Links::array(state.displacement), Links::array(state.velocity), Links::array(state.moving_mass)});
  stress_.share({Links::array(state.stress)});
}

void SharedState::parted(State& state) {
  if (alone())
    return;
  const bool filled = shares_->filled(); // maybe on rank 0 alone
  since_whole_ = whole_ || filled ? 0 : since_whole_ + 1;
  since_surfaces_ = surfaces_whole() || filled ? 0 : since_surfaces_ + 1;
  state.parted = shares_;
  whole_ = surfaces_whole_ = false;
  if (since_whole_ != release_after && since_surfaces_ != release_after)
    return;
  since_whole_ == release_after ? shares_->release(state) : shares_->release_motion(state);
  share_nodes(state); // what is read of others was on those pages too
}

void SharedState::gather_surfaces(State& state) {
  if (state.parted && !surfaces_whole_)
    shares_->gather_surfaces(state);
  surfaces_whole_ = true;
}

void SharedState::part_contacts(State& state) {
  if (alone())
    return;
  state.parted = shares_;
  contacts_whole_ = false;
}

void SharedState::gather_contacts(State& state) {
  if (!contacts_whole_)
    shares_->gather_contacts(state);
  contacts_whole_ = true;
}

void SharedState::look_at(const State& state) {
  if (!state.parted)
    whole_ = contacts_whole_ = true;
}

void SharedState::gather(State& state) {
  if (state.parted && !whole_)
    shares_->gather(state);
  gather_contacts(state);
  state.parted.reset();
  whole_ = true;
}

void SharedState::keep(State& state, State& copy) const {
  if (alone()) {
    copy = state;
    return;
  }
  shares_->copy(state, copy);
  copy.parted = shares_;
}

} // namespace cdem
