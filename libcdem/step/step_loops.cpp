// The loops of a step over chunks and rigid bodies. One loop computes the forces of a chunk and moves its nodes, since the
// forces are then still in the cache.
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/parallel/exact_sum.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/step.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace cdem {
namespace {

constexpr double NodeSums::*members[] = {
    &NodeSums::residual2, &NodeSums::applied2,   &NodeSums::reaction2,     &NodeSums::stiffness,
    &NodeSums::inertia,   &NodeSums::kinetic,    &NodeSums::external,      &NodeSums::damping,
    &NodeSums::radiated,  &NodeSums::fictitious, &NodeSums::led_residual2, &NodeSums::led_reaction2};
constexpr std::size_t n_members = std::size(members);
static_assert(n_members * sizeof(double) == sizeof(NodeSums), "all of them are summed");

// Over all chunks and rigid bodies of all ranks, exactly, then rounded. tellers: a number that is summed over the ranks in
// the same message.
NodeSums sums_of(const Workspace& work, std::int64_t& tellers) {
  const Range own = work.part().chunks();
  using Exact = ExactSums<n_members>;
  Exact exact;
  const auto add = [&](const NodeSums& sums) {
    for (std::size_t i = 0; i < n_members; ++i)
      if (const double x = sums.*members[i]; x != 0)
        exact.add(i, x);
  };
  for (std::int64_t c = own.begin; c < own.end; ++c)
    add(work.node_sums[c]);
  for (int rigid = 0; rigid < static_cast<int>(work.rigid_sums.size()); ++rigid)
    if (work.shared->moves(rigid))
      add(work.rigid_sums[rigid]);
  std::array<std::int64_t, Exact::size() + 1> told;
  std::copy_n(exact.data(), Exact::size(), told.begin());
  told.back() = tellers;
  ranks().sum(told.data(), told.size());
  std::copy_n(told.begin(), Exact::size(), exact.data());
  tellers = told.back();
  NodeSums sum;
  for (std::size_t i = 0; i < n_members; ++i)
    sum.*members[i] = exact.value(i);
  return sum;
}

std::int64_t stars_of(const Model& model) {
  return static_cast<std::int64_t>(model.chunks.size() - model.mesh.chunks.size());
}

} // namespace

void Stage::begin_forces() {
  breaking_ = breaking;
  work.hand_over_due = is_due(hand_over_every);
  work.shared->parted(context_.state);
}

void Stage::begin_cracks() {
  if (!breaking || context_.model.mesh.sides.empty())
    return;
  begun_ = begun_cracks();
  progress_.times.end(StepLine::cracks);
}

// Each chunk of springs writes its own forces only.
void Stage::bond_forces() {
  if (context_.model.point_chunks.empty())
    return;
  for_chunks(work.part().point_chunks(), context_.threads,
             [&](std::int64_t c) { spring_forces(context_.model, context_.state, work.bond, c, breaking); });
  work.shared->share_springs(work.bond.spring_force, work.bond.acting_force);
  progress_.times.end(StepLine::bonds);
}

// The nodes that no other chunk touches are all of a block, the inner ones of a chunk of a mesh.
void Stage::element_forces(Procedure& by) {
  const Model& model = context_.model;
  const std::int64_t stars = stars_of(model);
  const Range chunks = work.part().chunks();
  for_chunks(chunks.size(), context_.threads, [&](std::int64_t i) {
    const std::int64_t c = chunks.end - 1 - i;
    NodeSums sums;
    if (c < stars) {
      by.move(model.chunks[c].nodes, block_forces(model, context_.state, work, c), sums);
      work.node_sums[c] = sums;
      return;
    }
    const MeshChunk& chunk = model.mesh.chunks[c - stars];
    if (is_rigid(model, chunk))
      return;
    const Node* const force = mesh_forces(model, context_.state, work, c - stars, breaking);
    sums.applied2 = work.face_sums[c - stars].applied2;
    if (chunk.stars)
      each_deformable_run(model, chunk, [&](Range nodes) {
        by.move(nodes, force + (nodes.begin - chunk.nodes.begin), sums);
      });
    else
      by.move({chunk.nodes.begin, chunk.inner_end}, force, sums);
    work.node_sums[c] = sums;
  });
  work.near.crack_known = breaking && work.watch;
  work.near.due_known = work.near.crack_known && work.strain_step > 0;
  work.shared->share_partial_forces(work.partial);
  progress_.times.end(StepLine::elements);
}

// Adds the forces of all chunks on a node, in their order.
void Stage::shared_node_forces(Procedure& by) {
  if (!work.has_shared_nodes)
    return;
  const Model& model = context_.model;
  for_chunks(work.part().mesh_chunks(), context_.threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.stars || is_rigid(model, chunk))
      return;
    NodeSums sums = work.node_sums[stars_of(model) + c];
    ReadAhead ahead = shared_reads_of(model, context_.state, work, c + 1);
    ahead.spread(chunk.nodes.end - chunk.inner_end);
    each_shared_force(model.mesh, work, chunk, ahead,
                      [&](Range nodes, const Node* force) { by.move(nodes, force, sums); });
    work.node_sums[stars_of(model) + c] = sums;
  });
  progress_.times.end(StepLine::shared_nodes);
}

void Stage::rigid_bodies(Procedure& by) {
  if (context_.model.rigid.empty())
    return;
  const auto each = [&](const std::vector<int>& bodies, const auto& act) {
    for_chunks(static_cast<std::int64_t>(bodies.size()), context_.threads,
               [&](std::int64_t i) { act(bodies[i]); });
  };
  const auto move = [&](int body) {
    NodeSums sums;
    by.move_rigid(body, sums);
    work.rigid_sums[body] = sums;
  };
  each(work.shared->moved_bodies(), move);
  if (in_real_time) {
    work.shared->share_rigid(context_.state, work.rigid_angle);
    each(work.shared->placed_bodies(), [&](int body) { by.place_rigid(body); });
  }
  progress_.times.end(StepLine::rigid_bodies);
}

void Stage::sum_up() {
  const Range cracks = work.resolved.cracks.empty() ? Range() : work.part().mesh_chunks();
  work.shared->share_nodes(context_.state);
  for (std::int64_t c = cracks.begin; c < cracks.end; ++c)
    work.node_sums[stars_of(context_.model) + c].external +=
        crack_work(context_.state, work.face_sums[c].pushes, kick_);
  std::int64_t tellers = has_to_tell(work, begun_) ? 1 : 0;
  report.sums = sums_of(work, tellers);
  share_sums(work, begun_, tellers);
  if (!work.shared->alone())
    progress_.times.end(StepLine::ranks);
}

} // namespace cdem
