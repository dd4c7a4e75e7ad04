// Changes of a model between its stages.
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/bond/water_work.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/notch.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/procedure/catch_up.hpp"
#include "libcdem/procedure/give_motion.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libcdem/simulation_impl.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace cdem {
namespace {

double stored_energy(const Model& model, const State& state) {
  return elastic_energy(model, state) + spring_energy(model, state) + mesh_spring_energy(model, state);
}

// Turns the selected blocks rigid or deformable.
std::int64_t convert(SimulatedModel& s, const Selection& on,
                     std::int64_t (*set)(Model&, State&, const std::vector<int>&)) {
  std::vector<int> blocks;
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b)
    if (selects_block(s.model, on, b)) {
      if (!s.model.blocks[b].meshed)
        throw geom::InputError("on", on.text, "meshed bodies",
                               "block " + std::to_string(s.model.blocks[b].id) +
                                   " is of small strain, which always deforms");
      blocks.push_back(b);
    }
  if (blocks.empty())
    throw geom::InputError("on", on.text, "a place that holds the centroids of meshed bodies",
                           "nothing of the model lies there");
  Model changed = s.model;
  State moved = s.whole();
  if (!s.replaying)
    catch_up_velocities(s.model, moved, s.conditions);
  const std::int64_t count = set(changed, moved, blocks);
  if (count == 0)
    return 0;
  if (!s.replaying)
    resolve(changed, moved, s.conditions); // a rigid body cannot be held in part
  s.model = std::move(changed);
  s.changing() = std::move(moved);
  s.last_good = s.kept;
  return count;
}

} // namespace

void SimulatedModel::adopt(Rebuilt&& rebuilt) {
  State& state = changing();
  const double before = cdem::energy(model, state).total(), water = water_work(model, state);
  model = std::move(rebuilt.model);
  state = std::move(rebuilt.state);
  state.spent.cutting += before - cdem::energy(model, state).total();
  state.spent.external += water - water_work(model, state);
  last_good = state;
}

void Simulation::reduce_strength(double factor, const StrengthKinds& kinds) {
  if (const double share = excavation_kept(); share > 0)
    impl_->warnings.tell(fmt::format(
        "reduce_strength: forces of an excavation are kept, up to {:.3g} of their size: they hold the rock "
        "like a support, and a factor of safety counts on them; model:relax_excavation{{}} lets them go",
        share));
  impl_->change_conditions();
  cdem::reduce_strength(impl_->model, factor, kinds);
}

BeyondStrength Simulation::initial_stress(const InitialStress& field) {
  Impl& s = *impl_;
  const double before = stored_energy(s.model, s.whole());
  State changed = s.whole();
  add_initial_stress(s.model, changed, field);
  s.changing() = std::move(changed);
  s.kept.spent.cutting += before - stored_energy(s.model, s.kept);
  s.warnings.of_initial_stress(field);
  return beyond_strength(s.model, s.whole());
}

void Simulation::initial_stress(const Selection& on, const std::array<double, 6>& stress) {
  initial_stress(InitialStress{on, stress});
}

WaterInJoints Simulation::water(const Water& water) {
  Impl& s = *impl_;
  WaterInJoints sum;
  if (!s.replaying) { // else it stands in the state that is restored
    State changed = s.whole();
    sum = set_water(s.model, changed, water);
    s.changing() = std::move(changed);
    s.warnings.of_distant_table(water.table);
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
    s.warnings.of_open_water(still.back());
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
  impl_->warnings.of_joined_pieces(on);
  return convert(*impl_, on, set_rigid);
}

std::int64_t Simulation::make_deformable(const Selection& on) {
  return convert(*impl_, on, set_deformable);
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
  const double before = stored_energy(s.model, state);
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
  state.spent.cutting += before - stored_energy(s.model, state);
  s.last_good = state;
  return count;
}

} // namespace cdem
