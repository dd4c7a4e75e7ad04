#include "libcdem/state/state.hpp"

#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>

namespace cdem {
namespace {

// At rest; displacement and velocity are there.
void add_rigid_states(const Model& model, State& state) {
  if (model.rigid.empty())
    return;
  state.rigid_offset.resize(model.node_position.size());
  for (const RigidBody& body : model.rigid) {
    const Block& block = model.blocks[body.block];
    const geom::Vec3 centroid = rigid_shape(model, body.block, state.displacement.data()).centroid;
    for (int i = block.node_begin; i < block.node_end; ++i)
      state.rigid_offset[i] = node(place_of(model, state, i) - centroid);
    RigidState motion;
    motion.centroid = {centroid.x(), centroid.y(), centroid.z()};
    state.rigid.push_back(motion);
  }
}

} // namespace

const std::vector<double>& moving_mass(const Model& model, const State& state) {
  return state.moving_mass.empty() ? model.node_mass : state.moving_mass;
}

FaceSlip& slip_of(State& state, std::int64_t batch, int lane) {
  std::int32_t& first = state.faces[batch].slip;
  if (first < 0) {
    first = static_cast<std::int32_t>(state.face_slip.size());
    state.face_slip.resize(state.face_slip.size() + lanes);
  }
  return state.face_slip[first + lane];
}

const FaceSlip* slip_of(const State& state, std::int64_t batch, int lane) {
  const std::int32_t first = state.faces[batch].slip;
  return first < 0 ? nullptr : &state.face_slip[first + lane];
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

State initial_state(const Model& model) {
  State state;
  state.displacement.resize(model.node_position.size());
  state.velocity.resize(model.node_position.size());
  state.bond_offset.assign(model.points.size(), geom::Vec3::Zero());
  state.bond_mode.resize(model.points.size());
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const bool bonded = model.joints[model.interfaces[model.points[p].interface].joint].bonded;
    state.bond_mode[p] = static_cast<std::uint8_t>(bonded ? BondMode::intact : BondMode::contact);
  }
  const bool softens = std::any_of(model.joints.begin(), model.joints.end(),
                                   [](const Joint& joint) { return joint.softening != Softening::none; });
  state.bond_damage.assign(softens ? model.points.size() : 0, 0.0);
  state.bond_slip.assign(softens ? model.points.size() : 0, geom::Vec3::Zero());
  const bool laws = std::any_of(model.joints.begin(), model.joints.end(),
                                [](const Joint& joint) { return has_law(joint.law); });
  state.joint_history.assign(laws ? model.points.size() : 0, JointHistory{});
  state.released.assign(model.frames.size(), 0);
  state.initial_stress.assign(small_strain_tets(model), Stress{});
  state.stress.assign(model.mesh.batches.size(), StressBatch{});
  if (std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const Body& body) { return body.material.stiffness_damping > 0; }))
    state.viscous_stress = state.stress;
  if (!model.mesh.plastic_law.empty())
    state.plastic_strain.assign(model.mesh.batches.size(), PlasticStrainBatch{});
  if (std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const Body& body) { return body.bonding.is_cohesive(); }))
    state.cohesive.resize(model.mesh.face_tets.size());
  if (std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const Body& body) { return body.has_rate_effect(); }))
    state.rate_factor.assign(model.mesh.face_tets.size(), 1.0);
  FaceStateBatch whole{};
  whole.slip = -1;
  state.faces.assign(model.mesh.faces.size(), whole);
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    if (model.bodies[model.blocks[chunk.block].body].joint.bonded)
      return;
    state.faces[at.batch].mode[at.point][at.lane] = static_cast<std::uint8_t>(BondMode::contact);
    slip_of(state, at.batch, at.lane);
  });
  add_rigid_states(model, state);
  return state;
}

std::vector<StateField> fields(State& s) {
  const auto field = [](const char* name, const char* unit, FieldPlace place, const char* writer, auto& array,
                        bool floating) {
    const auto resize = [&array](std::size_t bytes) {
      array.resize(bytes / sizeof(array[0]));
      return bytes % sizeof(array[0]) == 0;
    };
    return StateField{name,     unit,  place, writer, array.data(), array.size() * sizeof(array[0]),
                      floating, resize};
  };
  const auto shown = [](StateField of_results) {
    of_results.shown_only = true;
    return of_results;
  };
  return {
      {"time", "s", FieldPlace::model, "run", &s.time, sizeof s.time, true},
      {"step", "1", FieldPlace::model, "end_step", &s.step, sizeof s.step, false},
      {"velocity_lag", "s", FieldPlace::model, "run, relax", &s.velocity_lag, sizeof s.velocity_lag, true},
      field("displacement", "m", FieldPlace::node, "step_nodes, relax_nodes, move_rigid", s.displacement,
            true),
      field("velocity", "m/s", FieldPlace::node, "step_nodes, relax_nodes, move_rigid", s.velocity, true),
      field("bond_offset", "m", FieldPlace::bond, "spring_forces", s.bond_offset, true),
      field("bond_mode", "1", FieldPlace::bond, "spring_forces", s.bond_mode, false),
      field("bond_damage", "1", FieldPlace::bond, "spring_forces", s.bond_damage, true),
      field("bond_slip", "m", FieldPlace::bond, "spring_forces", s.bond_slip, true),
      field("joint_history", "m", FieldPlace::bond, "spring_forces", s.joint_history, true),
      field("slid_before", "m", FieldPlace::bond, "renew_interfaces", s.slid_before, true),
      field("water_pressure", "Pa", FieldPlace::bond, "set_water", s.water_pressure, true),
      field("released", "1", FieldPlace::frame, "release_interfaces", s.released, false),
      field("initial_stress", "Pa", FieldPlace::tet, "initial_stress", s.initial_stress, true),
      field("stress", "Pa", FieldPlace::tet, "mesh_forces", s.stress, true),
      field("viscous_stress", "Pa", FieldPlace::tet, "mesh_forces", s.viscous_stress, true),
      field("plastic_strain", "1", FieldPlace::tet, "mesh_forces", s.plastic_strain, true),
      field("faces", "1", FieldPlace::face, "mesh_forces", s.faces, false),
      field("face_slip", "m", FieldPlace::face, "mesh_forces, record_face_breaks", s.face_slip, true),
      field("cohesive", "record", FieldPlace::face, "begin_cracks, mesh_forces", s.cohesive, true),
      field("rate_factor", "1", FieldPlace::face, "begin_cracks", s.rate_factor, true),
      field("contacts", "record", FieldPlace::contact, "contact_forces", s.contacts, false),
      field("tet_contacts", "record", FieldPlace::contact, "contact_forces", s.tet_contacts, false),
      field("rigid", "record", FieldPlace::rigid_body, "move_rigid, set_rigid", s.rigid, true),
      field("rigid_offset", "m", FieldPlace::node, "set_rigid", s.rigid_offset, true),
      shown(
          field("displacement_zero", "m", FieldPlace::node, "reset_displacement", s.displacement_zero, true)),
      field("support_force", "N", FieldPlace::node, "quiet, free_field", s.support_force, true),
      field("column_displacement", "m", FieldPlace::column, "advance_columns", s.column_displacement, true),
      field("column_velocity", "m/s", FieldPlace::column, "advance_columns", s.column_velocity, true),
      field("bolts", "record", FieldPlace::bolt, "set_bolt, advance_bolts", s.bolts, true),
      field("moving_mass", "kg", FieldPlace::node, "run", s.moving_mass, true),
      field("escaped", "1", FieldPlace::node, "find_escapes", s.escaped, false),
      field("crack_energy", "J", FieldPlace::body,
            "record_bond_breaks, record_face_breaks, record_begun_cracks", s.crack_energy, true),
      {"spent", "J", FieldPlace::model,
       "record_bond_breaks, record_face_breaks, ContactUpdate, record_step, relax", &s.spent, sizeof s.spent,
       true},
  };
}

std::uint64_t hash(const State& state) {
  std::uint64_t h = 14695981039346656037ull;
  for (const StateField& field : fields(const_cast<State&>(state))) {
    if (field.shown_only)
      continue;
    const auto* byte = static_cast<const unsigned char*>(field.data);
    for (std::size_t i = 0; i < field.bytes; ++i)
      h = (h ^ byte[i]) * 1099511628211ull;
  }
  return h;
}

} // namespace cdem
