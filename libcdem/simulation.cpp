#include "libcdem/simulation_impl.hpp"

#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/checkpoint/model_archive.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/fracture/notch.hpp"
#include "libcdem/load/flow.hpp"
#include "libcdem/procedure/critical_flow.hpp"
#include "libcdem/procedure/give_motion.hpp"
#include "libcdem/procedure/grow.hpp"
#include "libcdem/procedure/refine.hpp"
#include "libcdem/procedure/relax.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/procedure/settle.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/results/units.hpp"
#include "libcdem/results/watch_carried.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libgeom/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {

Simulation::Simulation(const ModelSpec& spec, int threads, std::shared_ptr<Observer> observer)
    : impl_(std::make_unique<Impl>()) {
  if (threads < 1)
    throw geom::InputError("threads", std::to_string(threads), "an integer >= 1");
  impl_->threads = threads;
  impl_->observer = observer ? std::move(observer) : std::make_shared<Observer>();
  impl_->model = first_model(spec);
  impl_->built = hash(impl_->model);
  impl_->kept = initial_state(impl_->model);
  impl_->last_good = impl_->whole();
  impl_->log.unmet = pairs_without_interface(spec, impl_->model);
}

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation Simulation::copy() const {
  auto other = std::make_unique<Impl>();
  other->model = impl_->model;
  other->kept = impl_->whole();
  other->last_good = impl_->kept;
  if (impl_->end_of_run) {
    make_whole(impl_->last_good);
    other->last_good = impl_->last_good;
    other->end_of_run = impl_->end_of_run;
    other->end_of_run->point.breaks = 0; // it has no log
    other->end_of_run->point.one_way = {};
  }
  other->conditions = impl_->conditions;
  other->log.unmet = impl_->log.unmet;
  other->observer = impl_->observer;
  other->threads = impl_->threads;
  other->last_residual = impl_->last_residual;
  other->built = impl_->built;
  return Simulation(std::move(other));
}

void Simulation::reduce_strength(double factor, const StrengthKinds& kinds) {
  if (const double share = excavation_kept(); share > 0)
    impl_->tell(fmt::format(
        "reduce_strength: forces of an excavation are kept, up to {:.3g} of their size: they hold the rock "
        "like a support, and a factor of safety counts on them; model:relax_excavation{{}} lets them go",
        share));
  impl_->end_of_run.reset();
  cdem::reduce_strength(impl_->model, factor, kinds);
}

void Simulation::fix(const Fix& fix) {
  if (fix.displacement)
    require_finite("displacement", *fix.displacement);
  if (fix.velocity)
    require_finite("velocity", *fix.velocity);
  if (fix.displacement && fix.velocity)
    throw geom::InputError("displacement and velocity: give one of them");
  impl_->add_condition([&](Conditions& c) {
    add_fix(c.fixes, fix);
    const auto same = [&](const auto& boundary) { return selects_same(boundary.on, fix.on); };
    c.quiets.erase(std::remove_if(c.quiets.begin(), c.quiets.end(), same), c.quiets.end());
    c.free_fields.erase(std::remove_if(c.free_fields.begin(), c.free_fields.end(), same),
                        c.free_fields.end());
  });
}

void Simulation::release(const Selection& on, std::array<bool, 3> axes) {
  impl_->add_condition([&](Conditions& c) {
    Fix release;
    release.on = on;
    release.axes = axes;
    release.release = true;
    add_fix(c.fixes, release);
  });
}

namespace {

// Whether a load acts where one of those before it does. chosen: the faces or nodes of a selection, ascending.
template <class Load>
bool meets_earlier(std::vector<int> (*chosen)(const Model&, const Selection&), const Model& model,
                   const std::vector<Load>& before, const Load& load) {
  const std::vector<int> here = chosen(model, load.on);
  return std::any_of(before.begin(), before.end(), [&](const Load& earlier) {
    const std::vector<int> there = chosen(model, earlier.on);
    return std::any_of(there.begin(), there.end(),
                       [&](int place) { return std::binary_search(here.begin(), here.end(), place); });
  });
}

} // namespace

bool Simulation::traction(const Traction& traction) {
  require_finite("stress", traction.stress);
  if (traction.pressure && traction.pressure->level) {
    geom::require(std::isfinite(*traction.pressure->level), "level", *traction.pressure->level,
                  "a finite height z (m)");
    geom::require_above("weight", traction.pressure->weight, 0, "N/m3", "water has 9810");
  }
  if (traction.pressure)
    impl_->warn_of_distant_table(traction.pressure->table);
  const std::vector<Traction> before = impl_->conditions.tractions;
  impl_->add_condition([&](Conditions& c) { c.tractions.push_back(traction); });
  return !impl_->replaying && meets_earlier(selected_outer_faces, impl_->model, before, traction);
}

bool Simulation::force(const PointForce& force) {
  require_finite("force", force.force);
  const std::vector<PointForce> before = impl_->conditions.forces;
  impl_->add_condition([&](Conditions& c) { c.forces.push_back(force); });
  return !impl_->replaying && meets_earlier(selected_nodes, impl_->model, before, force);
}

void Simulation::gravity(const Gravity& gravity) {
  require_finite("vector", gravity.acceleration);
  geom::require_at_least("water_density", gravity.water_density, 0, "kg/m3");
  if (gravity.turning && gravity.amplitude)
    throw geom::InputError(
        "amplitude: goes with a constant vector; let the function that turns it scale it too");
  impl_->end_of_run.reset();
  impl_->conditions.gravity = gravity;
}

namespace {

// The last flow pushes on a face that another pushes on too, as the faces stand undeformed.
bool flows_meet(const Model& model, const ResolvedConditions& r) {
  const auto meets = [&](const ResolvedFlow& flow, int f) { // a field may push from anywhere
    return flow.water || model.outer_faces[f].normal.dot(flow.direction) < 0;
  };
  const ResolvedFlow& last = r.flows.back();
  std::vector<char> met(model.outer_faces.size(), 0);
  for (std::size_t i = 0; i + 1 < r.flows.size(); ++i)
    for (const int f : r.flows[i].faces)
      met[f] = met[f] || meets(r.flows[i], f);
  return std::any_of(last.faces.begin(), last.faces.end(), [&](int f) { return met[f] && meets(last, f); });
}

} // namespace

bool Simulation::flow(const Flow& flow) {
  check(flow);
  impl_->end_of_run.reset();
  Conditions changed = impl_->conditions;
  changed.flows.push_back(flow);
  if (impl_->replaying) {
    impl_->conditions = std::move(changed);
    return false;
  }
  const ResolvedConditions resolved = resolve(impl_->model, impl_->whole(), changed);
  if (!flow.water && !flow.new_faces &&
      flow_pattern(impl_->model, impl_->whole(), resolved.flows.back()).empty())
    throw geom::InputError("direction", geom::shown(flow.direction),
                           "a direction that meets an outer face of the place (" + flow.on.text + ")",
                           "a flow along x+ pushes on the side x-");
  impl_->conditions = std::move(changed);
  return flows_meet(impl_->model, resolved);
}

void Simulation::crack_pressure(const CrackPressure& pressure) {
  if (pressure.volume)
    for (const auto& [field, value] :
         {std::pair{"bulk_modulus", pressure.bulk_modulus}, std::pair{"reservoir", pressure.reservoir}})
      geom::require_above(field, value, 0, "", "it goes with volume");
  if (!impl_->replaying)
    require_cracks(impl_->model, pressure.on);
  impl_->add_condition([&](Conditions& c) { c.crack_pressures.push_back(pressure); });
}

void Simulation::clear_loads() {
  impl_->end_of_run.reset();
  impl_->conditions.crack_pressures.clear();
  impl_->conditions.flows.clear();
  impl_->conditions.tractions.clear();
  impl_->conditions.forces.clear();
  impl_->conditions.gravity.reset();
}

BeyondStrength Simulation::initial_stress(const InitialStress& field) {
  Impl& s = *impl_;
  const double before = s.stored_energy();
  State changed = s.whole();
  add_initial_stress(s.model, changed, field);
  s.changing() = std::move(changed);
  s.kept.spent.cutting += before - s.stored_energy();
  s.warn_of_dry_rock(field);
  if (s.stage == 0 && !s.replaying) {
    s.given_stress.push_back({field, {}});
    for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b)
      s.given_stress.back().has.push_back(selects_block(s.model, field.on, b) ? 1 : 0);
  }
  return beyond_strength(s.model, s.whole());
}

void Simulation::initial_stress(const Selection& on, const std::array<double, 6>& stress) {
  InitialStress field;
  field.on = on;
  field.stress = stress;
  initial_stress(field);
}

WaterInJoints Simulation::water(const Water& water) {
  Impl& s = *impl_;
  WaterInJoints sum;
  if (!s.replaying) { // else it stands in the state that is restored
    State changed = s.whole();
    sum = set_water(s.model, changed, water);
    s.changing() = std::move(changed);
    s.warn_of_distant_table(water.table);
  }
  s.end_of_run.reset();
  std::vector<StillWater>& still = s.conditions.still_waters;
  const bool everywhere = water.sets.empty() && selects_same(water.on, Selection::everything());
  const auto replaced = [&](const StillWater& other) {
    return everywhere || (other.sets == water.sets && selects_same(other.on, water.on));
  };
  still.erase(std::remove_if(still.begin(), still.end(), replaced), still.end());
  if (water.level || water.table) {
    still.push_back({water.on, water.sets, water.level, water.table});
    s.warn_of_open_water(still.back());
  }
  return sum;
}

void Simulation::reset_displacement() {
  impl_->kept.displacement_zero = impl_->whole().displacement;
  impl_->last_good.displacement_zero = impl_->kept.displacement_zero;
}

void Simulation::initial_velocity(const Selection& on, const geom::Vec3& velocity,
                                  const geom::Vec3& angular_velocity,
                                  const std::optional<geom::Vec3>& about) {
  require_finite("velocity", velocity);
  require_finite("angular_velocity", angular_velocity);
  if (about)
    require_finite("about", *about);
  Impl& s = *impl_;
  const std::vector<int> nodes = selected_nodes(s.model, on);
  if (nodes.empty())
    throw geom::InputError("on", on.text, "a place that holds nodes", "nothing of the model lies there");
  const RigidMotion motion{velocity, angular_velocity,
                           about ? *about : centroid_of(s.model, s.whole(), nodes)};
  if (!s.replaying && fixes_stop(s.conditions.fixes, s.model, s.whole(), nodes, motion))
    throw geom::InputError(
        "on", on.text, "a place that may move as it is told",
        "model:fix holds every node there in these directions; release them first, or give the "
        "fix a velocity");
  State& state = s.changing();
  const double given = give_motion(s.model, state, nodes, motion, on.text);
  state.spent.external += given;
  state.spent.external_peak = std::max(state.spent.external_peak, std::abs(state.spent.external));
}

std::int64_t Simulation::make_rigid(const Selection& on) {
  impl_->warn_of_welded_pieces(on);
  return impl_->convert(on, set_rigid);
}

std::int64_t Simulation::make_deformable(const Selection& on) {
  return impl_->convert(on, set_deformable);
}

std::size_t Simulation::watch(const std::string& body, double leaves) {
  Impl& s = *impl_;
  Watch watch = start_watch(s.model, s.whole(), body, leaves);
  if (s.watches == s.log.watches.size()) // else it has been restored
    s.log.watches.push_back(std::move(watch));
  return s.watches++;
}

const std::vector<Departure>& Simulation::departures(std::size_t watch) const {
  return impl_->log.watches.at(watch).left;
}

std::int64_t Simulation::break_bonds(const Selection& on, bool whole_faces) {
  Impl& s = *impl_;
  State& state = s.changing();
  std::vector<char> selected(s.model.points.size());
  for (int p = 0; p < static_cast<int>(selected.size()); ++p)
    selected[p] = selects_point(s.model, on, p);
  if (whole_faces)
    for (const Interface& interface : s.model.interfaces) {
      const auto begin = selected.begin() + interface.point_begin,
                 end = selected.begin() + interface.point_end;
      if (std::find(begin, end, 0) != end)
        std::fill(begin, end, 0);
    }
  std::int64_t count = 0;
  const double before = s.stored_energy();
  for (int p = 0; p < static_cast<int>(s.model.points.size()); ++p)
    if (selected[p]) {
      state.bond_mode[p] = static_cast<std::uint8_t>(BondMode::contact);
      if (!state.bond_damage.empty()) {
        state.bond_damage[p] = 0;
        state.bond_offset[p] += state.bond_slip[p];
        state.bond_slip[p].setZero();
      }
      cdem::settle(s.model, state, p);
      ++count;
    }
  count += notch(s.model, state, [&](const geom::Vec3& place, int block) {
    return selects_place(s.model, on, place, block);
  });
  const std::vector<Node> position = present_places(s.model, state);
  each_face_spring(s.model.mesh, [&](const MeshChunk& chunk, FaceSpringPlace at) {
    if (s.model.bodies[s.model.blocks[chunk.block].body].bonding.is_cohesive())
      return;
    const auto holds = [&](int point) {
      at.point = point;
      return selects_place(s.model, on, face_point(s.model, chunk, at), chunk.block);
    };
    const int point = at.point;
    if (whole_faces ? !(holds(0) && holds(1) && holds(2)) : !holds(point))
      return;
    state.faces[at.batch].mode[point][at.lane] = static_cast<std::uint8_t>(BondMode::contact);
    FaceSlip slip = slip_of(state, at.batch, at.lane);
    cdem::settle(s.model.mesh.faces[at.batch], face_nodes(s.model.mesh, chunk, at.batch, at.lane), point,
                 at.lane, position.data(), state.displacement.data(),
                 face_law(s.model, chunk, at.batch, at.lane), slip);
    slips_of(state, at.batch).set(at.lane, slip);
    ++count;
  });
  if (count == 0)
    throw geom::InputError("on", on.text,
                           whole_faces
                               ? "a place that holds whole interfaces"
                               : "a place that holds bonds, of a cohesive body whole faces of its mesh",
                           "nothing of the model lies there");
  state.spent.cutting += before - s.stored_energy();
  s.last_good = state;
  return count;
}

namespace {

// A stage that goes on from a checkpoint finds in its log what it has come to.
void sample_every(const StageContext& context, std::int64_t steps) {
  if (steps > 0 && (!context.from || context.from->step == 0))
    context.log.every = steps;
}

} // namespace

RelaxResult Simulation::relax(const RelaxOptions& options) {
  check(options);
  impl_->warn_of_falling_forces();
  RelaxResult result = impl_->run_stage([&](const StageContext& context) {
    sample_every(context, options.history_every);
    return cdem::relax(context, options);
  });
  impl_->last_residual = result.residual;
  return result;
}

RunResult Simulation::run(const RunOptions& options) {
  check(options);
  const double begin = time();
  const std::array<double, 4> step_choice{options.safety, options.time_step, options.mass_scaling.step,
                                          options.mass_scaling.factor};
  RunResult result = impl_->run_stage(
      [&](const StageContext& context) {
        sample_every(context, options.history_every);
        return cdem::run(context, options);
      },
      &step_choice);
  impl_->last_residual = impl_->log.history.back().residual;
  impl_->look_for_dry_flows(begin, time());
  return result;
}

std::vector<BlockCut> Simulation::refine(const RefineOptions& options) {
  impl_->require_blocks("refine");
  if (options.region) {
    bool holds_blocks = false;
    for (int b = 0; b < static_cast<int>(impl_->model.blocks.size()); ++b)
      holds_blocks = holds_blocks || selects_block(impl_->model, *options.region, b);
    if (!holds_blocks)
      throw geom::InputError("region", options.region->text, "a place that holds block centroids",
                             "nothing of the model lies there");
  }
  Refined refined = cdem::refine(impl_->model, impl_->whole(), options);
  ++impl_->stage;
  impl_->adopt(std::move(refined.rebuilt));
  return std::move(refined.cuts);
}

GrowResult Simulation::grow(const GrowOptions& options) {
  impl_->require_blocks("grow");
  Impl& s = *impl_;
  return s.run_whole_stage([&](const StageContext& context) {
    const auto relax = [&](const RelaxOptions& o, const std::string& kind) {
      RelaxResult result = cdem::relax(context, o, kind);
      s.last_residual = result.residual;
      return result;
    };
    return cdem::grow({s.model, s.changing(), s.log, *s.observer, context.number, relax,
                       [&](Rebuilt&& r) { s.adopt(std::move(r)); }},
                      options);
  });
}

Deformation Simulation::deformation() const {
  return largest_deformation(impl_->model, impl_->whole());
}

bool Simulation::has_buoyancy() const {
  return impl_->conditions.gravity && impl_->conditions.gravity->water_density > 0;
}

bool Simulation::has_gravity() const {
  return impl_->conditions.gravity.has_value();
}

geom::Vec3 Simulation::gravity_vector() const {
  return has_gravity() ? impl_->conditions.gravity->acceleration : geom::Vec3::Zero();
}

bool Simulation::anything_acts() const {
  const Conditions& c = impl_->conditions;
  if (c.load() || !c.quiets.empty())
    return true;
  const State& s = impl_->whole();
  if (!s.water_pressure.empty())
    return true;
  const auto moves = [](const Fix& fix) { return fix.displacement || fix.velocity; };
  const auto is_nonzero = [](const Node& n) { return n.x != 0 || n.y != 0 || n.z != 0; };
  const auto is_strained = [](const StressBatch& batch) {
    for (const auto& component : batch.component)
      if (std::any_of(std::begin(component), std::end(component), [](double x) { return x != 0; }))
        return true;
    return false;
  };
  const auto is_stressed = [](const Stress& stress) {
    return std::any_of(stress.begin(), stress.end(), [](double x) { return x != 0; });
  };
  return std::any_of(c.fixes.begin(), c.fixes.end(), moves) ||
         std::any_of(s.displacement.begin(), s.displacement.end(), is_nonzero) ||
         std::any_of(s.velocity.begin(), s.velocity.end(), is_nonzero) ||
         std::any_of(s.initial_stress.begin(), s.initial_stress.end(), is_stressed) ||
         std::any_of(s.stress.begin(), s.stress.end(), is_strained);
}

SettleResult Simulation::settle(const SettleOptions& options) {
  check(options);
  SettleResult result = impl_->run_stage(
      [&](const StageContext& context) { return cdem::settle(impl_->model, context, options); });
  impl_->last_residual = impl_->log.history.back().residual;
  return result;
}

CriticalFlowResult Simulation::critical_flow(const CriticalFlowOptions& options) {
  check(options);
  CriticalFlowResult result =
      impl_->run_stage([&](const StageContext& context) { return cdem::critical_flow(context, options); });
  impl_->last_residual = impl_->log.history.back().residual;
  return result;
}

} // namespace cdem
