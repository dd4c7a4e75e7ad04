#include "libcdem/checkpoint/require_fits.hpp"

#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem {
namespace {

[[noreturn]] void refuse_state(const std::string& field, const std::string& what) {
  throw geom::InputError("the saved state does not fit its model: " + field + ": " + what +
                         "; the file was changed, or written by another version of cdem");
}

void require_entries(const std::string& field, std::size_t length, std::size_t wanted,
                     bool may_be_empty = false) {
  if (length != wanted && !(may_be_empty && length == 0))
    refuse_state(field, std::to_string(length) + " entries where there must be " + std::to_string(wanted));
}

template <class Integer>
void require_below(const std::string& field, Integer value, std::size_t end) {
  if (value < 0 || static_cast<std::size_t>(value) >= end)
    refuse_state(field, std::to_string(value) + " is out of range");
}

constexpr std::size_t modes = static_cast<std::size_t>(BondMode::contact) + 1,
                      escapes = static_cast<std::size_t>(Escaped::held) + 1;

void check_faces(const State& state) {
  for (const FaceStateBatch& batch : state.faces) {
    for (const auto& point : batch.mode)
      for (const std::uint8_t mode : point)
        require_below("faces.mode", mode, modes);
    for (const FaceStage stage : batch.stage)
      require_below("faces.stage", static_cast<std::size_t>(stage),
                    static_cast<std::size_t>(FaceStage::parted) + 1);
    if (batch.slip < -1)
      refuse_state("faces.slip", std::to_string(batch.slip) + " is out of range");
    if (batch.slip >= 0)
      require_below("faces.slip", batch.slip + lanes - 1, state.face_slip.size());
  }
}

void check_contacts(const Model& model, const State& state) {
  const std::size_t triangles = model.surface.triangles.size();
  const auto triangle = [&](const char* field, std::int64_t t) {
    require_below(std::string("contacts.") + field, t, triangles);
  };
  for (const Contact& c : state.contacts) {
    triangle("source", c.source / 3);
    if (c.kind == Contact::spring) {
      triangle("target", c.target);
      require_below("contacts.fragment", c.fragment, std::max(model.node_position.size(), triangles));
    } else {
      triangle("target", c.target < 0 ? c.target : c.target / 3);
      triangle("fragment", c.fragment);
      triangle("beside", c.beside);
    }
    const auto block = [&](std::int64_t t) {
      return model.surface.triangles[static_cast<std::size_t>(t)].block;
    };
    if (!contact_joint(model, block(c.source / 3),
                       block(c.kind == Contact::spring ? c.target : c.target / 3)))
      refuse_state("contacts", "of two blocks that have no law of contact");
  }
  for (const TetContact& c : state.tet_contacts) {
    for (const std::int32_t tet : {c.a, c.b})
      if (require_below("tet_contacts", tet, model.tets.size()); tet < model.mesh.first_tet)
        refuse_state("tet_contacts", "of a block of small strain");
    if (!(c.a < c.b) || model.tet_block[c.a] != model.tet_block[c.b] ||
        !contact_joint(model, model.tet_block[c.a], model.tet_block[c.b]))
      refuse_state("tet_contacts", "of tetrahedra that cannot touch");
  }
}

} // namespace

void require_fits(const Model& model, const State& state) {
  const std::size_t nodes = model.node_position.size(), points = model.points.size();
  require_entries("displacement", state.displacement.size(), nodes);
  require_entries("velocity", state.velocity.size(), nodes);
  require_entries("bond_offset", state.bond_offset.size(), points);
  require_entries("bond_mode", state.bond_mode.size(), points);
  const State fresh = initial_state(model); // says which of the others the model has at all
  require_entries("bond_damage", state.bond_damage.size(), fresh.bond_damage.size());
  require_entries("bond_slip", state.bond_slip.size(), fresh.bond_slip.size());
  require_entries("joint_history", state.joint_history.size(), fresh.joint_history.size());
  for (const JointHistory& history : state.joint_history)
    if (!(history.path >= 0 && history.parted >= 0))
      refuse_state("joint_history",
                   std::to_string(std::min(history.path, history.parted)) + " is out of range");
  require_entries("slid_before", state.slid_before.size(), points, true);
  require_entries("water_pressure", state.water_pressure.size(), points, true);
  for (const double pressure : state.water_pressure)
    if (!(pressure >= 0))
      refuse_state("water_pressure", std::to_string(pressure) + " is out of range");
  require_entries("released", state.released.size(), model.frames.size());
  require_entries("initial_stress", state.initial_stress.size(), small_strain_tets(model));
  require_entries("displacement_zero", state.displacement_zero.size(), nodes, true);
  require_entries("stress", state.stress.size(), model.mesh.batches.size());
  require_entries("viscous_stress", state.viscous_stress.size(), fresh.viscous_stress.size());
  require_entries("plastic_strain", state.plastic_strain.size(), fresh.plastic_strain.size());
  for (const PlasticStrainBatch& batch : state.plastic_strain)
    for (const double strain : batch.strain)
      if (!(strain >= 0))
        refuse_state("plastic_strain", std::to_string(strain) + " is out of range");
  require_entries("faces", state.faces.size(), model.mesh.faces.size());
  require_entries("cohesive", state.cohesive.size(), fresh.cohesive.size());
  require_entries("rate_factor", state.rate_factor.size(), fresh.rate_factor.size());
  for (const double factor : state.rate_factor)
    if (!(factor >= 1))
      refuse_state("rate_factor", std::to_string(factor) + " is out of range");
  require_entries("rigid", state.rigid.size(), model.rigid.size());
  require_entries("rigid_offset", state.rigid_offset.size(), nodes, model.rigid.empty());
  require_entries("support_force", state.support_force.size(), nodes, true);
  require_entries("column_velocity", state.column_velocity.size(), state.column_displacement.size());
  require_entries("moving_mass", state.moving_mass.size(), nodes, true);
  for (const double mass : state.moving_mass)
    if (!(mass > 0))
      refuse_state("moving_mass", std::to_string(mass) + " is out of range");
  require_entries("escaped", state.escaped.size(), nodes, true);
  require_entries("crack_energy", state.crack_energy.size(), model.bodies.size() + 1, true);
  for (const std::uint8_t mode : state.bond_mode)
    require_below("bond_mode", mode, modes);
  for (const std::uint8_t escaped : state.escaped)
    require_below("escaped", escaped, escapes);
  check_faces(state);
  check_contacts(model, state);
}

} // namespace cdem
