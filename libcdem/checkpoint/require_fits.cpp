#include "libcdem/checkpoint/require_fits.hpp"

#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

[[noreturn]] void refuse_state(const std::string& field, const std::string& what) {
  throw geom::InputError("the saved state does not fit its model: " + field + ": " + what +
                         "; the file was changed, or written by another version of cdem");
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
                    static_cast<std::size_t>(FaceStage::separated) + 1);
    if (batch.slip < -1)
      refuse_state("faces.slip", std::to_string(batch.slip) + " is out of range");
    if (batch.slip >= 0)
      require_below("faces.slip", batch.slip, state.face_slip.size());
  }
}

void check_told_bonds(const State& state) {
  for (const std::uint8_t told : state.told_bonds)
    require_below("told_bonds", told, static_cast<std::size_t>(ToldOfBonds::all_broken) + 1);
}

void check_contacts(const Model& model, const State& state) {
  const std::size_t triangles = model.surface.triangles.size();
  const auto triangle = [&](const char* field, std::int64_t t) {
    require_below(std::string("contacts.") + field, t, triangles);
  };
  const auto check = [&](const Contact& c) {
    for (const auto& [field, value] : {std::pair("contacts.at_rest", c.at_rest),
                                       {"contacts.peak", c.peak},
                                       {"contacts.usual_force", c.usual_force},
                                       {"contacts.felt_force", c.felt_force}})
      if (!(value >= 0 && std::isfinite(value)))
        refuse_state(field, std::to_string(value) + " is out of range");
    if (!(c.from_end > 0 && c.from_end <= 1))
      refuse_state("contacts.from_end", std::to_string(c.from_end) + " is out of range");
    if (c.kind == Contact::tets) {
      require_below("contacts.source", c.source, model.tets.size());
      require_below("contacts.target", c.target, model.tets.size());
      const int block = model.tet_block[c.source];
      if (model.tet_block[c.target] != block || !contact_joint(model, block, block))
        refuse_state("contacts", "of two tetrahedra that have no law of contact");
      return;
    }
    if (c.kind > Contact::tets)
      refuse_state("contacts", "of no kind");
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
  };
  for (const Contact& c : state.contacts)
    check(c);
  for (const OpenedContact& opened : state.opened_contacts) {
    if (opened.last.kind == Contact::tets)
      refuse_state("opened_contacts", "of two tetrahedra");
    check(opened.last);
    if (!(opened.left > 0))
      refuse_state("opened_contacts.left", std::to_string(opened.left) + " is out of range");
  }
}

void check_excavation(const Model& model, const State& state) {
  for (const ExcavationForce& force : state.excavation) {
    require_below("excavation.node", force.node, model.node_position.size());
    for (const double share : {force.before, force.after})
      if (!(share >= 0 && share <= 1))
        refuse_state("excavation.share", std::to_string(share) + " is out of range");
    if (!(force.duration >= 0))
      refuse_state("excavation.duration", std::to_string(force.duration) + " is out of range");
    for (const double number : {force.x, force.y, force.z, force.begin, force.duration})
      if (!std::isfinite(number))
        refuse_state("excavation", std::to_string(number) + " is no finite number");
  }
}

} // namespace

void require_fits(const Model& model, const State& state) {
  each_field(
      [&](const FieldRow& row, const auto& field) {
        if constexpr (is_array<decltype(field)>) {
          const std::size_t wanted = entries_of(row, model).value_or(field.size());
          if (field.size() != wanted && !(row.need == FieldNeed::later && field.empty()))
            refuse_state(row.name, std::to_string(field.size()) + " entries where there must be " +
                                       std::to_string(wanted));
        }
      },
      state);
  if (state.column_velocity.size() != state.column_displacement.size())
    refuse_state("column_velocity", "its length is not that of column_displacement");
  for (const JointHistory& history : state.joint_history)
    if (!(history.path >= 0 && history.parted >= 0))
      refuse_state("joint_history",
                   std::to_string(std::min(history.path, history.parted)) + " is out of range");
  for (const double rested : state.rested)
    if (!(rested >= 0 && rested <= 1))
      refuse_state("rested", std::to_string(rested) + " is out of range");
  for (const double pressure : state.water_pressure)
    if (!(pressure >= 0))
      refuse_state("water_pressure", std::to_string(pressure) + " is out of range");
  for (const PlasticStrainBatch& batch : state.plastic_strain)
    for (const double strain : batch.strain)
      if (!(strain >= 0))
        refuse_state("plastic_strain", std::to_string(strain) + " is out of range");
  for (const TimeBatch& batch : state.near_at)
    for (const double time : batch.time)
      if (!std::isfinite(time))
        refuse_state("near_at", std::to_string(time) + " is out of range");
  for (const double factor : state.rate_factor)
    if (!(factor >= 1))
      refuse_state("rate_factor", std::to_string(factor) + " is out of range");
  for (const double mass : state.moving_mass)
    if (!(mass > 0))
      refuse_state("moving_mass", std::to_string(mass) + " is out of range");
  for (const std::uint8_t mode : state.bond_mode)
    require_below("bond_mode", mode, modes);
  for (const std::uint8_t escaped : state.escaped)
    require_below("escaped", escaped, escapes);
  check_faces(state);
  check_told_bonds(state);
  check_contacts(model, state);
  check_excavation(model, state);
}

} // namespace cdem
