#include "libcdem/step/record.hpp"

#include "libcdem/step/support_forces.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/bond/water_work.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/build/add_meshes.hpp"
#include "libcdem/results/cracks.hpp"
#include "libcdem/results/fields.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cdem {

namespace {

// The slip of a face one of whose springs has just broken.
FaceSlip begun(FaceSlip slip, int point, const FaceBreak& broken) {
  std::copy(std::begin(broken.slip), std::end(broken.slip), slip.value[point]);
  std::copy(std::begin(broken.shear), std::end(broken.shear), slip.shear[point]);
  return slip;
}

// event: how the bond of the row broke.
template <class Event>
void add_break(const Event& event, BreakRow row, RunLog& log) {
  row.mode = event.mode;
  row.normal_traction = event.normal_traction;
  row.shear_traction = event.shear_traction;
  log.breaks.push_back(row);
  ++(event.mode == BondMode::broken_tension ? log.broken_tension : log.broken_shear);
}

// The bond of a face, in one block.
BreakRow row_of_face(const Model& model, const MeshChunk& chunk, const FaceSpringPlace& at,
                     const geom::Vec3& normal, BreakRow row) {
  row.place = face_point(model, chunk, at);
  row.normal = normal;
  row.area = model.mesh.faces[at.batch].area[at.lane];
  row.block_a = row.block_b = model.blocks[chunk.block].id;
  return row;
}

} // namespace

void strike_out_met(const Model& model, const State& state, RunLog& log) {
  if (log.unmet.empty())
    return;
  std::vector<double> met(log.unmet.size(), 0.0);
  for (const Contact& contact : state.contacts) {
    const auto [one, other] = blocks_of(model, contact);
    const int a = model.blocks[one].body, b = model.blocks[other].body;
    const auto here =
        std::find(log.unmet.begin(), log.unmet.end(), std::array{std::min(a, b), std::max(a, b)});
    if (here != log.unmet.end())
      met[here - log.unmet.begin()] = 1;
  }
  ranks().largest(met.data(), met.size());
  std::size_t left = 0;
  for (std::size_t i = 0; i < met.size(); ++i)
    if (met[i] == 0)
      log.unmet[left++] = log.unmet[i];
  log.unmet.resize(left);
}

std::int64_t record_bond_breaks(const Model& model, State& state, const Workspace& work, RunLog& log,
                                int stage, std::int64_t step) {
  EnergyLedger& spent = state.spent;
  std::int64_t count = 0;
  for (const SpringSums& sums : work.bond.sums) {
    spent.friction += sums.friction;
    spent.breaking += sums.breaking;
    spent.damping += sums.damping;
    for (const CrackLoss& loss : sums.losses) {
      const Interface& interface = model.interfaces[loss.interface];
      const int a = model.blocks[interface.block_a].body, b = model.blocks[interface.block_b].body;
      crack_energy_of(model, state, a == b ? a : static_cast<int>(model.bodies.size())) += loss.energy;
    }
    for (const BreakEvent& event : sums.broken) {
      const BondPoint& point = model.points[event.point];
      const Interface& interface = model.interfaces[point.interface];
      add_break(event,
                {stage, step, state.time, event.mode, model.point_position[event.point], point.normal,
                 point.area, 0, 0, model.blocks[interface.block_a].id, model.blocks[interface.block_b].id},
                log);
    }
    count += static_cast<std::int64_t>(sums.broken.size());
  }
  return count;
}

std::int64_t record_face_breaks(const Model& model, State& state, Workspace& work, RunLog& log, int stage,
                                std::int64_t step) {
  std::int64_t count = 0;
  for (std::size_t c = 0; c < work.face_sums.size(); ++c) {
    const FaceSums& sums = work.face_sums[c];
    const MeshChunk& chunk = model.mesh.chunks[c];
    const int body = model.blocks[chunk.block].body;
    if (sums.crack.tension != 0 || sums.crack.shear != 0)
      crack_energy_of(model, state, body) += sums.crack;
    state.spent.friction += sums.friction;
    state.spent.breaking += sums.breaking;
    state.spent.damping += sums.damping;
    state.spent.plastic += sums.plastic;
    if (sums.hands_over) {
      work.contact.search.fragments_due = true;
      work.contact.search.told_due[chunk.block] = 1;
    }
    for (const FaceBreak& broken : sums.broken) {
      const FaceSpringPlace at{chunk.face_batches.begin + broken.spring / (3 * lanes),
                               static_cast<int>(broken.spring / lanes % 3),
                               static_cast<int>(broken.spring % lanes)};
      add_break(broken, row_of_face(model, chunk, at, broken.normal, {stage, step, state.time}), log);
      if (!model.bodies[body].bonding.is_cohesive())
        slips_of(state, at.batch).set(at.lane, begun(slip_of(state, at.batch, at.lane), at.point, broken));
    }
    count += static_cast<std::int64_t>(sums.broken.size());
  }
  return count;
}

std::int64_t record_begun_cracks(const Model& model, State& state, const BegunCracks& begun, RunLog& log,
                                 int stage, std::int64_t step) {
  double stored = 0;
  for (const auto& [chunk, energy] : begun.breaking)
    stored += energy;
  for (const auto& [chunk, energy] : begun.relieved)
    stored += energy;
  state.spent.breaking += stored;
  for (const auto& [chunk, energy] : begun.energies)
    crack_energy_of(model, state, model.blocks[model.mesh.chunks[chunk].block].body) += energy;
  for (const BegunCracks::Break& broken : begun.broken) {
    const MeshChunk& chunk = model.mesh.chunks[broken.chunk];
    add_break(broken, row_of_face(model, chunk, broken.place, broken.normal, {stage, step, state.time}), log);
  }
  return static_cast<std::int64_t>(begun.broken.size());
}

void record_history(const StageContext& context, double residual, double kinetic,
                    std::shared_ptr<const TetsByPlace>& tets) {
  const Model& model = context.model;
  const State& state = context.state;
  RunLog& log = context.log;
  HistoryRow row;
  row.stage = context.number;
  row.step = state.step;
  row.time = state.time;
  row.residual = residual;
  row.kinetic = kinetic;
  row.external = state.spent.external + water_work(model, state);
  row.broken_tension = log.broken_tension;
  row.broken_shear = log.broken_shear;
  std::optional<CracksByBody> cracked; // looked at once, and only where somebody asks
  for (const Probe& probe : log.probes) {
    if (!probe.on.empty()) {
      const int axis = probe.crack.back() - 'x';
      if (is_momentum(probe)) {
        row.probes.push_back(momentum_of(model, state, probe.body)[axis]);
        continue;
      }
      row.probes.push_back(reaction(model, state, context.conditions, context.threads, *context.seen,
                                    place_of_support(model, probe.on))[axis]);
      continue;
    }
    if (probe.crack.empty()) {
      if (!tets)
        tets = tets_by_place(model);
      row.probes.push_back( // nan where no rock is any more
          value_at(model, state, probe.field, probe.place, *tets).value_or(std::nan("")));
      continue;
    }
    if (!cracked)
      cracked = cracks(model, state);
    row.probes.push_back(
        crack_quantity(probe.body < 0 ? cracked->all() : cracked->bodies[probe.body], probe.crack));
  }
  log.add(std::move(row));
}

void look_at_units(const Model& model, const State& state, const Conditions& conditions, RunLog& log) {
  if (log.watches.empty())
    return;
  double velocity = std::numeric_limits<double>::quiet_NaN();
  for (const Flow& flow : conditions.flows)
    if (flow.velocity)
      velocity = std::fmax(velocity, flow.velocity(state.time));
  for (Watch& watch : log.watches)
    look(model, state, velocity, watch);
}

} // namespace cdem
