#include "libcdem/stage_sequence.hpp"

#include "libcdem/checkpoint/model_archive.hpp"
#include "libcdem/checkpoint/require_fits.hpp"
#include "libcdem/checkpoint/require_whole.hpp"
#include "libcdem/results/earlier_log.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>

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
CDEM_ARCHIVE(BaredFace, face, parted)
CDEM_ARCHIVE(CrackSide, block, nodes, parted)
CDEM_ARCHIVE(AskedWater, block, first_node, time, nodes, cracks, bared)
CDEM_ARCHIVE(FlowPatterns::OfFlow, forces, corners, asked)
CDEM_ARCHIVE(FlowPatterns, flows)
CDEM_ARCHIVE(SlidingFriction::Sums, law, done, path, slip, contact, span, time, hops, end, way, turned, size,
             looks, joint)
CDEM_ARCHIVE(SlidingFriction, of_blocks, blocks, seen, told)
CDEM_ARCHIVE(RestartPoint, step, begun, breaks, wall_time, tension_before, shear_before, loop_state, carried,
             spring_force, stretch, viscous, one_way, contact_step, strain_step, near, slid, flows, sliding,
             procedure_state)
CDEM_ARCHIVE(SimulatedModel::End, point, step_choice, with_other_conditions)

StageContext StageSequence::next() {
  warnings_.before_stage(); // asks functions of a script, from which the run may be stopped
  StageContext context{of_.model,     of_.kept,      of_.conditions, of_.log,
                       of_.last_good, *of_.observer, of_.threads,    ++of_.stage};
  context.changing = &of_.model;
  context.checkpoints = checkpoints_;
  of_.seen = context.seen;
  return context;
}

void StageSequence::run(const Solve& solve, const std::optional<SimulatedModel::StepChoice>& step_choice) {
  const struct Leave {
    StageSequence& s;
    ~Leave() {
      s.in_stage_ = false;
      if (s.restart_point_) // else the stage was refused before it had begun, and nothing has changed
        s.of_.end_of_run.reset();
      s.restart_point_.reset();
    }
  } leave{*this};
  StageContext context = next();
  in_stage_ = true;
  context.restart_point = &restart_point_;
  std::optional<RestartPoint> entry = std::exchange(from_, std::nullopt);
  context.kept = &of_.work;
  context.sliding = &of_.sliding;
  if (entry)
    of_.last_good = of_.kept;
  else if (of_.end_of_run && step_choice && of_.end_of_run->step_choice == *step_choice &&
           !of_.end_of_run->with_other_conditions)
    entry = take_up(std::move(of_.end_of_run->point));
  else if (of_.end_of_run) {
    gather_springs(of_.end_of_run->point);
    context.before = &of_.end_of_run->point;
  }
  if (entry) {
    restart_point_ = entry;
    context.from = &*entry;
  }
  solve(context);
  if (step_choice)
    of_.end_of_run = SimulatedModel::End{*std::exchange(restart_point_, std::nullopt), *step_choice};
  of_.last_residual = of_.log.history.back().residual;
}

void StageSequence::run_whole(const Solve& solve) {
  const struct Leave {
    StageSequence& s;
    ~Leave() { s.at_start_.clear(); }
  } leave{*this};
  if (checkpoints_)
    at_start_ = save();
  solve(next());
}

void StageSequence::gather_springs(RestartPoint& point) const {
  if (const std::shared_ptr<const StateShares> shares = of_.last_good.parted)
    for (std::vector<geom::Vec3>* of_points : {&point.spring_force, &point.stretch, &point.viscous})
      shares->gather_points(*of_points);
}

// Takes off the log whatever the run before has reported and the next step finds again.
RestartPoint StageSequence::take_up(RestartPoint point) {
  gather_springs(point);
  if (of_.last_good.parted)
    make_whole(of_.last_good);
  of_.kept = of_.last_good;
  point.broken_tension_before = of_.log.broken_tension;
  point.broken_shear_before = of_.log.broken_shear;
  of_.sliding.seen = point.sliding.seen;
  go_back(of_.log, of_.kept.step, point.breaks, point.one_way);
  if (checkpoints_)
    checkpoints_->marked();
  return point;
}

std::string StageSequence::save() const {
  if (!at_start_.empty())
    return at_start_;
  const State& then = restart_point_ ? of_.last_good : of_.kept;
  const std::optional<RestartPoint>& point = restart_point_ ? restart_point_ : from_;
  Writer a;
  archive_const(a, of_.built);
  archive_const(a, of_.model.blocks.size());
  archive_const(a, of_.model.node_position.size());
  const bool as_built = hash(of_.model) == of_.built;
  archive_const(a, as_built);
  if (!as_built)
    write(a, of_.model);
  write(a, then);
  const bool ends = of_.end_of_run && !(restart_point_ && restart_point_->begun);
  archive_const(a, ends);
  if (ends) {
    write(a, of_.last_good);
    SimulatedModel::End end = *of_.end_of_run;
    end.with_other_conditions = end.with_other_conditions || restart_point_; // last_good is a start then
    archive_const(a, end);
  }
  archive_const(a, of_.last_residual);
  archive_const(a, in_stage_ ? of_.stage - 1 : of_.stage);
  if (point)
    write(a, of_.log, then.step, point->breaks, point->one_way);
  else
    write(a, of_.log, then.step, of_.log.breaks.size(), of_.log.one_way);
  const bool midway = point && (point->begun || !point->procedure_state.empty());
  archive_const(a, midway);
  if (midway)
    archive_const(a, *point);
  archive_const(a, midway ? point->sliding : of_.sliding);
  return a.take();
}

void StageSequence::restore(std::string_view saved, bool state_only) {
  Reader a(saved);
  std::uint64_t built_then = 0;
  std::size_t blocks = 0, nodes = 0;
  archive_all(a, built_then, blocks, nodes);
  if (built_then != of_.built)
    throw geom::InputError(
        fmt::format("the model is not the one that was saved: that had {} blocks and {} nodes when it was "
                    "saved, this has {} "
                    "and {}; build it as it was then, with the same shapes, materials, joints and contacts",
                    blocks, nodes, of_.model.blocks.size(), of_.model.node_position.size()));
  bool as_built = true;
  archive(a, as_built);
  if (as_built && hash(of_.model) != of_.built)
    throw geom::InputError("the model has been cut or changed since it was built; load a state before that");
  Model model_then;
  State state_then, state_at_end;
  if (!as_built) {
    read(a, model_then);
    require_whole(model_then);
  }
  read(a, state_then);
  require_fits(as_built ? of_.model : model_then, state_then);
  bool ends = false;
  archive(a, ends);
  std::optional<SimulatedModel::End> end_then;
  if (ends) {
    read(a, state_at_end);
    require_fits(as_built ? of_.model : model_then, state_at_end);
    end_then = SimulatedModel::End();
    archive(a, *end_then);
  }
  archive(a, of_.last_residual);
  if (!as_built) {
    take_names(of_.model, model_then);
    of_.model = std::move(model_then);
  }
  of_.kept = std::move(state_then);
  of_.last_good = ends ? std::move(state_at_end) : of_.kept;
  of_.end_of_run = std::move(end_then);
  of_.work = nullptr;
  from_.reset();
  int stage = 0;
  archive(a, stage);
  if (stage < 0)
    Reader::refuse();
  RunLog log;
  read(a, log);
  require_whole(of_.model, log);
  if (ends)
    require_whole(of_.model, log, of_.end_of_run->point);
  if (state_only) { // with what belongs to the state: what broke on the way to it, and how large energies were
    of_.log.breaks = std::move(log.breaks);
    of_.log.broken_tension = log.broken_tension;
    of_.log.broken_shear = log.broken_shear;
    of_.log.told_tension = log.told_tension;
    of_.log.told_shear = log.told_shear;
    of_.log.one_way = log.one_way;
    return;
  }
  of_.stage = stage;
  of_.log = std::move(log);
  archive(a, from_);
  archive(a, of_.sliding);
  if (from_)
    require_whole(of_.model, of_.log, *from_);
}

// A stage that runs keeps a copy in shares, and the end of a run.
void StageSequence::gather_to_save() {
  const std::shared_ptr<const StateShares> shares = of_.last_good.parted;
  RestartPoint* const point = restart_point_   ? &*restart_point_
                              : of_.end_of_run ? &of_.end_of_run->point
                                               : nullptr;
  if (!shares || !point)
    return;
  shares->gather_on_lead(of_.last_good);
  for (std::vector<Node>& of_nodes : point->carried)
    shares->gather_nodes_on_lead(of_nodes);
  for (std::vector<geom::Vec3>* of_points : {&point->spring_force, &point->stretch, &point->viscous})
    shares->gather_points_on_lead(*of_points);
}

} // namespace cdem
