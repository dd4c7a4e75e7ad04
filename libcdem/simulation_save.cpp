// A Simulation as bytes, and back.
#include "libcdem/checkpoint/model_archive.hpp"
#include "libcdem/checkpoint/require_fits.hpp"
#include "libcdem/checkpoint/require_whole.hpp"
#include "libcdem/results/earlier_log.hpp"
#include "libcdem/simulation_impl.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace cdem {
namespace {

int first_boundary(const Model& model, int block) {
  const auto& all = model.mesh.boundary; // by block
  return static_cast<int>(std::partition_point(all.begin(), all.end(),
                                               [&](const BoundaryTriangle& t) { return t.block < block; }) -
                          all.begin());
}

// The named faces of meshes, which are not saved, in a model that has lost blocks since it was built: a mesh keeps its id and
// the order of its outer faces.
void take_names(const Model& built, Model& then) {
  std::map<std::int64_t, int> first; // by the id of a block
  for (int b = 0; b < static_cast<int>(then.blocks.size()); ++b)
    if (!then.blocks[b].convex())
      first[then.blocks[b].id] = first_boundary(then, b);
  then.mesh.named.clear();
  for (const auto& [name, faces] : built.mesh.named)
    for (const int face : faces) {
      const int block = built.mesh.boundary[face].block;
      if (const auto found = first.find(built.blocks[block].id); found != first.end())
        then.mesh.named[name].push_back(found->second + face - first_boundary(built, block));
    }
}

} // namespace

CDEM_ARCHIVE(FlowCorner, node, inward, stream)
CDEM_ARCHIVE(WaterPoint, velocity, acceleration, pressure, surface, pressure_gradient, surface_slope)
CDEM_ARCHIVE(NodeInWater, place, water, inertia)
CDEM_ARCHIVE(AskedWater, block, first_node, nodes, opened)
CDEM_ARCHIVE(FlowPatterns::OfFlow, forces, corners, asked)
CDEM_ARCHIVE(FlowPatterns, flows, water_mass)
CDEM_ARCHIVE(RestartPoint, step, begun, breaks, wall_time, tension_before, shear_before, loop_state,
             previous_force, spring_force, stretch, viscous, one_way, contact_step, strain_step, near, slid,
             flows, procedure_state)

std::string Simulation::Impl::saved() const {
  if (!at_start.empty())
    return at_start;
  const State& then = restart_point ? last_good : kept;
  const std::optional<RestartPoint>& point = restart_point ? restart_point : from;
  Writer a;
  archive_const(a, built);
  archive_const(a, model.blocks.size());
  archive_const(a, model.node_position.size());
  const bool as_built = hash(model) == built;
  archive_const(a, as_built);
  if (!as_built)
    write(a, model);
  write(a, then);
  const bool ends = end_of_run && !restart_point;
  archive_const(a, ends);
  if (ends) {
    write(a, last_good);
    archive_const(a, end_of_run->point);
    archive_const(a, end_of_run->step_choice);
  }
  archive_const(a, last_residual);
  archive_const(a, in_stage ? stage - 1 : stage);
  if (point)
    write(a, log, then.step, point->breaks, point->one_way);
  else
    write(a, log, then.step, log.breaks.size(), log.one_way);
  const bool midway = point && (point->begun || !point->procedure_state.empty());
  archive_const(a, midway);
  if (midway)
    archive_const(a, *point);
  return a.take();
}

void Simulation::Impl::take(std::string_view saved, bool state_only) {
  Reader a(saved);
  std::uint64_t built_then = 0;
  std::size_t blocks = 0, nodes = 0;
  archive_all(a, built_then, blocks, nodes);
  if (built_then != built)
    throw geom::InputError(
        fmt::format("the model is not the one that was saved: that had {} blocks and {} nodes when it was "
                    "saved, this has {} "
                    "and {}; build it as it was then, with the same shapes, materials, joints and contacts",
                    blocks, nodes, model.blocks.size(), model.node_position.size()));
  bool as_built = true;
  archive(a, as_built);
  if (as_built && hash(model) != built)
    throw geom::InputError("the model has been cut or changed since it was built; load a state before that");
  Model model_then;
  State state_then;
  if (!as_built) {
    read(a, model_then);
    require_whole(model_then);
  }
  read(a, state_then);
  require_fits(as_built ? model : model_then, state_then);
  bool ends = false;
  archive(a, ends);
  State state_at_end;
  std::optional<End> end_then;
  if (ends) {
    read(a, state_at_end);
    require_fits(as_built ? model : model_then, state_at_end);
    end_then = End();
    archive(a, end_then->point);
    archive(a, end_then->step_choice);
  }
  archive(a, last_residual);
  if (!as_built) {
    take_names(model, model_then);
    model = std::move(model_then);
  }
  kept = std::move(state_then);
  last_good = ends ? std::move(state_at_end) : kept;
  end_of_run = std::move(end_then);
  from.reset();
  if (state_only) {
    if (end_of_run) {
      end_of_run->point.breaks = log.breaks.size();
      end_of_run->point.one_way = log.one_way;
      require_whole(model, log, end_of_run->point);
    }
    return;
  }
  archive(a, stage);
  if (stage < 0)
    Reader::refuse();
  read(a, log);
  require_whole(model, log);
  if (end_of_run)
    require_whole(model, log, end_of_run->point);
  bool midway = false;
  archive(a, midway);
  if (midway) {
    archive(a, from.emplace());
    require_whole(model, log, *from);
  }
}

// Takes off the log whatever the run before has reported and the next step finds again.
RestartPoint Simulation::Impl::take_up(End before) {
  RestartPoint point = std::move(before.point);
  if (const std::shared_ptr<const StateShares> shares = last_good.parted) {
    make_whole(last_good);
    for (std::vector<geom::Vec3>* of_points : {&point.spring_force, &point.stretch, &point.viscous})
      shares->gather_points(*of_points);
  }
  kept = last_good;
  point.broken_tension_before = log.broken_tension;
  point.broken_shear_before = log.broken_shear;
  go_back(log, kept.step, point.breaks, point.one_way);
  if (checkpoints)
    checkpoints->marked();
  return point;
}

// A stage that runs keeps a copy in shares, and the end of a run.
void Simulation::gather_to_save() {
  Impl& s = *impl_;
  const std::shared_ptr<const StateShares> shares = s.last_good.parted;
  RestartPoint* const point = s.restart_point ? &*s.restart_point
                              : s.end_of_run  ? &s.end_of_run->point
                                              : nullptr;
  if (!shares || !point)
    return;
  shares->gather_on_lead(s.last_good);
  shares->gather_nodes_on_lead(point->previous_force);
  for (std::vector<geom::Vec3>* of_points : {&point->spring_force, &point->stretch, &point->viscous})
    shares->gather_points_on_lead(*of_points);
}

std::string Simulation::save() const {
  return impl_->saved();
}
void Simulation::restore(const std::string& saved) {
  impl_->take(saved, false);
}
void Simulation::restore_state(const std::string& saved) {
  impl_->take(saved, true);
}
void Simulation::set_checkpoint_writer(CheckpointWriter* checkpoints) {
  impl_->checkpoints = checkpoints;
}
void Simulation::set_replaying(bool replaying) {
  impl_->replaying = replaying;
}

} // namespace cdem
