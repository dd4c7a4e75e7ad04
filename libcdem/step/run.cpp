#include "libcdem/step/run.hpp"

#include "libcdem/step/move_nodes.hpp"
#include "libcdem/step/move_rigid.hpp"
#include "libcdem/step/row_sums.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace cdem {
namespace {

// Bodies in free flight may travel; only what leaves the scene altogether has run away.
constexpr double run_away_lengths = 100;

// One component of a node of which some are held: the law of step_nodes where it is free.
struct Component {
  double free, prescribed, applied;
};

void advance(double force, double mass, double viscous, const Stepping& s, const Component& c,
             double& velocity, double& displacement, NodeSums& sums) {
  const double before = velocity;
  if (c.free != 0) {
    sums.residual2 += force * force;
    sums.applied2 += c.applied * c.applied;
    const double inertia = mass / s.kick;
    const double undamped = ((inertia - 0.5 * viscous) * before + force) / (inertia + 0.5 * viscous);
    const double most = s.local_damping * std::abs(force) / (inertia + 0.5 * viscous);
    velocity = before + undamped > most    ? undamped - most
               : before + undamped < -most ? undamped + most
                                           : 0 - before;
    const double against = (inertia + 0.5 * viscous) * (undamped - velocity);
    const double mean = 0.5 * (before + velocity);
    sums.external += c.applied * mean * s.kick;
    sums.damping += (viscous * mean + against) * mean * s.kick;
    sums.kinetic += 0.5 * mass * velocity * velocity;
  } else {
    sums.reaction2 += force * force;
    velocity = c.prescribed;
    const double ahead = 0.5 * s.time_step;
    sums.external += (c.applied - force) * ((s.kick - ahead) * before + ahead * velocity);
  }
  displacement += velocity * s.time_step;
}

void step_held_node(const MovingNodes& node, const HeldNode& h, const Stepping& stepping, NodeSums& sums) {
  const auto [f, load] = held_node_forces(node);
  const double m = *node.mass, viscous = node.viscous ? *node.viscous : 0;
  Node &v = *node.velocity, &u = *node.displacement;
  advance(f.x, m, viscous, stepping, {h.free.x, h.prescribed.x, load.x}, v.x, u.x, sums);
  advance(f.y, m, viscous, stepping, {h.free.y, h.prescribed.y, load.y}, v.y, u.y, sums);
  advance(f.z, m, viscous, stepping, {h.free.z, h.prescribed.z, load.z}, v.z, u.z, sums);
}

// mu V of every node, N s/m; empty when nothing is viscous.
std::vector<double> viscous_forces(const Model& model) {
  std::vector<double> viscous;
  if (std::all_of(model.bodies.begin(), model.bodies.end(),
                  [](const Body& body) { return body.material.viscosity == 0; }))
    return viscous;
  viscous.reserve(model.node_volume.size());
  for (std::size_t i = 0; i < model.node_volume.size(); ++i)
    viscous.push_back(model.bodies[model.blocks[model.node_block[i]].body].material.viscosity *
                      model.node_volume[i]);
  return viscous;
}

double choose_time_step(const Model& model, const RunOptions& options) {
  const double stable = stable_time_step(model);
  if (options.time_step == 0 && std::isinf(stable))
    throw geom::InputError(
        "time_step: missing; everything that moves is rigid and touches nothing, which has no "
        "stable step to take: give one (s)");
  if (options.time_step > stable)
    throw geom::InputError("time_step", fmt::format("{:g}", options.time_step),
                           fmt::format("at most the stable step, {:.4g} s", stable),
                           "leave it out to use safety x stable");
  return options.time_step > 0 ? options.time_step : options.safety * stable;
}

} // namespace

double stable_time_step(const Model& model) {
  const std::vector<double> sums = all_row_sums(model);
  double largest = 0;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (model.blocks[model.node_block[i]].rigid < 0)
      largest = std::max(largest, sums[i] / model.node_mass[i]);
  return 2 / std::sqrt(largest);
}

RunResult run(const StageContext& context, const RunOptions& options, const std::string& kind) {
  State& state = context.state;
  const Moment* const from = context.from;
  Stepping stepping{choose_time_step(context.model, options), 0, options.local_damping};
  Stage stage(context, kind, run_away_lengths * context.model.length);
  const std::vector<double> viscous = viscous_forces(context.model);
  Stage::StepReport report;
  const double start = from ? from->carried.at(0) : state.time;
  const std::int64_t steps =
      options.steps > 0 ? options.steps
                        : static_cast<std::int64_t>(std::ceil(options.duration / stepping.time_step - 1e-9));
  // What only `stop` ends has no goal to tell of.
  if (steps < std::numeric_limits<std::int64_t>::max()) {
    report.goals.max_steps = steps;
    report.goals.time_goal = start + static_cast<double>(steps) * stepping.time_step;
  }
  const std::int64_t ask_every = options.callback_every > 0 ? options.callback_every : 100;

  bool stopped = false;
  while (stage.step < steps && !stopped) {
    if (stage.can_be_left())
      stage.mark({start});
    update_external(stage.work.resolved, state.time);
    // Velocities that stand at the time of the displacements, at the start or after a relaxation, take half a step.
    stepping.kick = state.velocity_lag + 0.5 * stepping.time_step;
    const auto move = [&](Range range, const Node* force, NodeSums& sums) {
      const auto nodes = [&](Range part) {
        MovingNodes moving = moving_nodes(state, stage.work, context.model.node_mass, part,
                                          force + (part.begin - range.begin));
        moving.viscous = viscous.empty() ? nullptr : viscous.data() + part.begin;
        return moving;
      };
      each_node(
          stage.work.resolved, range, [&](Range part) { step_nodes(nodes(part), stepping, sums); },
          [&](const HeldNode& h) {
            step_held_node(nodes({h.node, h.node + 1}), h, stepping, sums);
          });
    };
    report.sums = stage.advance(options.breaking, move, [&](int rigid, NodeSums& sums) {
      move_rigid(context.model, state, stage.work, rigid, stepping, sums);
    });
    stage.work.strain_step = stepping.time_step;
    report.residual = relative_residual(report.sums);
    state.time = start + static_cast<double>(stage.step + 1) * stepping.time_step;
    state.velocity_lag = 0.5 * stepping.time_step;
    stage.after_step(report);
    if (stage.step % ask_every == 0) {
      if (options.callback || options.stop)
        stage.catch_up(); // what they read is of one moment
      if (options.callback && options.callback_every > 0)
        options.callback();
      stopped = options.stop && options.stop();
    }
  }
  stage.finish(report);

  RunResult result;
  result.steps = stage.step;
  result.time = state.time;
  result.time_step = stepping.time_step;
  result.broken_tension = stage.broken_tension();
  result.broken_shear = stage.broken_shear();
  result.wall_time = stage.wall_time();
  return result;
}

} // namespace cdem
