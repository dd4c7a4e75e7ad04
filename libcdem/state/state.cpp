#include "libcdem/state/state.hpp"

#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/state/carry.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

// A member of State that is not in the table does not compile.
static_assert(sizeof(State) == sizeof(State::parted)
// NOLINTNEXTLINE(bugprone-macro-parentheses)
#define FIELD(type, name, unit, place, need, carried, shared, looked, writer) +sizeof(type)
#include "libcdem/state/fields.inc"
#undef FIELD
                  ,
              "every field of State is in state/fields.inc");

namespace {

// At rest; displacement and velocity are there.
void set_rigid_states(const Model& model, State& state) {
  for (std::size_t r = 0; r < model.rigid.size(); ++r) {
    const Block& block = model.blocks[model.rigid[r].block];
    const geom::Vec3 centroid = rigid_shape(model, model.rigid[r].block, state.displacement.data()).centroid;
    for (int i = block.node_begin; i < block.node_end; ++i)
      state.rigid_offset[i] = node(place_of(model, state, i) - centroid);
    state.rigid[r].centroid = {centroid.x(), centroid.y(), centroid.z()};
  }
}

template <class Is>
bool any_body(const Model& model, const Is& is) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), is);
}
template <class Is>
bool any_joint(const Model& model, const Is& is) {
  return std::any_of(model.joints.begin(), model.joints.end(), is);
}

bool has(FieldNeed need, const Model& model) {
  switch (need) {
  case FieldNeed::always:
    return true;
  case FieldNeed::softening_joints:
    return any_joint(model, [](const Joint& joint) { return joint.softening != Softening::none; });
  case FieldNeed::joint_laws:
    return any_joint(model, [](const Joint& joint) { return has_law(joint.law); });
  case FieldNeed::stiffness_damping:
    return any_body(model, [](const Body& body) { return body.material.stiffness_damping > 0; });
  case FieldNeed::plastic_bodies:
    return !model.mesh.plastic_law.empty();
  case FieldNeed::cohesive_bodies:
    return any_body(model, [](const Body& body) { return body.bonding.is_cohesive(); });
  case FieldNeed::rate_effect:
    return any_body(model, [](const Body& body) { return body.has_rate_effect(); });
  case FieldNeed::rigid_bodies:
    return !model.rigid.empty();
  case FieldNeed::later:
    break;
  }
  return false;
}

// Number of entries that belong to a place; nothing where the model does not say.
std::optional<std::size_t> places(FieldPlace place, const Model& model) {
  switch (place) {
  case FieldPlace::node:
    return model.node_position.size();
  case FieldPlace::bond:
    return model.points.size();
  case FieldPlace::frame:
    return model.frames.size();
  case FieldPlace::small_strain_tet:
    return small_strain_tets(model);
  case FieldPlace::tet_batch:
    return model.mesh.batches.size();
  case FieldPlace::face_batch:
    return model.mesh.faces.size();
  case FieldPlace::face:
    return model.mesh.face_tets.size();
  case FieldPlace::rigid_body:
    return model.rigid.size();
  case FieldPlace::body:
    return model.bodies.size() + 1;
  case FieldPlace::model:
  case FieldPlace::slip:
  case FieldPlace::contact:
  case FieldPlace::column:
  case FieldPlace::bolt:
  case FieldPlace::excavation:
    break;
  }
  return std::nullopt;
}

} // namespace

const std::vector<double>& moving_mass(const Model& model, const State& state) {
  return state.moving_mass.empty() ? model.node_mass : state.moving_mass;
}

FaceSlipBatch& slips_of(State& state, std::int64_t batch) {
  std::int32_t& place = state.faces[batch].slip;
  if (place < 0) {
    place = static_cast<std::int32_t>(state.face_slip.size());
    state.face_slip.emplace_back();
  }
  return state.face_slip[place];
}

FaceSlip slip_of(const State& state, std::int64_t batch, int lane) {
  const std::int32_t place = state.faces[batch].slip;
  return place < 0 ? FaceSlip{} : state.face_slip[place].at(lane);
}

Stress mesh_stress(const Model& model, const State& state, int tet) {
  const int slot = model.mesh.tet_slot[tet - model.mesh.first_tet];
  Stress stress{};
  for (int c = 0; c < 6; ++c)
    stress[c] = state.stress[slot / lanes].component[c][slot % lanes];
  return stress;
}

void set_mesh_stress(const Model& model, State& state, int tet, const Stress& stress) {
  const int slot = model.mesh.tet_slot[tet - model.mesh.first_tet];
  for (int c = 0; c < 6; ++c)
    state.stress[slot / lanes].component[c][slot % lanes] = stress[c];
}

double& plastic_strain_of(const Model& model, State& state, int tet) {
  const int slot = model.mesh.tet_slot[tet - model.mesh.first_tet];
  return state.plastic_strain[slot / lanes].strain[slot % lanes];
}

double plastic_strain_of(const Model& model, const State& state, int tet) {
  return plastic_strain_of(model, const_cast<State&>(state), tet);
}

std::size_t small_strain_tets(const Model& model) {
  return model.mesh.empty() ? model.tets.size() : static_cast<std::size_t>(model.mesh.first_tet);
}

Node shown_displacement(const State& state, int node) {
  Node u = state.displacement[node];
  if (!state.displacement_zero.empty()) {
    const Node& zero = state.displacement_zero[node];
    u.x -= zero.x;
    u.y -= zero.y;
    u.z -= zero.z;
  }
  return u;
}

CrackEnergy& crack_energy_of(const Model& model, State& state, int body) {
  if (state.crack_energy.empty())
    state.crack_energy.resize(model.bodies.size() + 1);
  return state.crack_energy[body];
}

std::optional<std::size_t> entries_of(const FieldRow& row, const Model& model) {
  if (row.need != FieldNeed::later && !has(row.need, model))
    return 0;
  return places(row.place, model);
}

namespace {

State initial_state_of(const Model& model, bool with_tets) {
  State state;
  each_field(
      [&](const FieldRow& row, auto& field) {
        if constexpr (is_array<decltype(field)>)
          if (row.need != FieldNeed::later && (with_tets || row.place != FieldPlace::tet_batch))
            field.assign(entries_of(row, model).value_or(0), first_entry(field));
      },
      state);
  std::fill(state.rate_factor.begin(), state.rate_factor.end(), 1.0);
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const bool bonded = model.joints[model.interfaces[model.points[p].interface].joint].bonded;
    state.bond_mode[p] = static_cast<std::uint8_t>(bonded ? BondMode::intact : BondMode::contact);
  }
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    if (model.bodies[model.blocks[chunk.block].body].joint.bonded)
      return;
    state.faces[at.batch].mode[at.point][at.lane] = static_cast<std::uint8_t>(BondMode::contact);
    slips_of(state, at.batch);
  });
  set_rigid_states(model, state);
  return state;
}

} // namespace

State initial_state(const Model& model) {
  return initial_state_of(model, true);
}

State initial_state_without_tets(const Model& model) {
  return initial_state_of(model, false);
}

const char* field_with_nan(const State& state) {
  const char* found = nullptr;
  each_field(
      [&](const FieldRow& row, const auto& field) {
        if constexpr (is_array<decltype(field)>) {
          using Entry = std::remove_cv_t<std::remove_reference_t<decltype(field[0])>>;
          if constexpr (is_all_doubles<Entry>) {
            static_assert(sizeof(Entry) % sizeof(double) == 0);
            const auto* number = reinterpret_cast<const double*>(field.data());
            constexpr std::size_t each = sizeof(Entry) / sizeof(double); // NOLINT(bugprone-sizeof-expression)
            if (!found && row.place != FieldPlace::tet_batch &&
                !std::all_of(number, number + field.size() * each, [](double x) { return std::isfinite(x); }))
              found = row.name;
          }
        }
      },
      state);
  return found;
}

std::vector<StateField> fields(State& state) {
  std::vector<StateField> all;
  each_field(
      [&](const FieldRow& row, auto& field) {
        if constexpr (is_array<decltype(field)>)
          all.push_back({row, field.data(), field.size() * sizeof field[0], [&field](std::size_t bytes) {
                           field.resize(bytes / sizeof field[0], first_entry(field));
                           return bytes % sizeof field[0] == 0;
                         }});
        else
          all.push_back({row, &field, sizeof field});
      },
      state);
  return all;
}

std::uint64_t hash(const State& state) {
  std::uint64_t h = 14695981039346656037ull;
  for (const StateField& field : fields(const_cast<State&>(state))) {
    if (field.row.looked == FieldLooked::shown)
      continue;
    const auto* byte = static_cast<const unsigned char*>(field.data);
    for (std::size_t i = 0; i < field.bytes; ++i)
      h = (h ^ byte[i]) * 1099511628211ull;
  }
  return h;
}

} // namespace cdem
