// State: every array that changes while stepping.
#pragma once

#include "libcdem/bolt/bolt.hpp"
#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/joint/joint_spring.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/cohesive_face.hpp"
#include "libcdem/state/contact.hpp"
#include "libcdem/state/crack_energy.hpp"
#include "libcdem/state/excavation_force.hpp"
#include "libcdem/state/face_state.hpp"
#include "libcdem/state/ledger.hpp"
#include "libcdem/state/rigid_state.hpp"
#include "libcdem/state/stress_batch.hpp"
#include "libcdem/state/table.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace cdem {

class StateShares; // ranks/state_shares.hpp

// Per node: its piece is inside the model, has left it (a warning has named it), or is held where it was then.
enum class Escaped : std::uint8_t { inside, told, held };

// Its members are those of the table: meaning, unit, place and writer of each stand in state/fields.inc.
struct State {
#define FIELD(type, name, unit, place, need, carried, shared, looked, writer) type name{};
#include "libcdem/state/fields.inc"
#undef FIELD

  // With several ranks: how they share it, while each holds its own part only; null: it is whole. No field.
  std::shared_ptr<const StateShares> parted;
};

std::size_t small_strain_tets(const Model&); // the first so many tets of a model

// Displacement since it was last set to zero, m.
Node shown_displacement(const State&, int node);
const std::vector<double>& moving_mass(const Model&, const State&); // kg (n_nodes)

// The slip of a face's broken springs; zero slip is made room for when there is none yet.
FaceSlipBatch& slips_of(State&, std::int64_t batch);          // there is room for them from now on
FaceSlip slip_of(const State&, std::int64_t batch, int lane); // zero where no spring of the batch is broken

// The stress that State::stress holds for a tet of a mesh (its number in the model), Pa; of a rigid block in the
// directions it was made rigid in.
Stress mesh_stress(const Model&, const State&, int tet);
void set_mesh_stress(const Model&, State&, int tet, const Stress&);

// Equivalent plastic strain of a tet of a mesh (its number in the model).
double& plastic_strain_of(const Model&, State&, int tet);
double plastic_strain_of(const Model&, const State&, int tet);

// Where the crack energy of a body goes; body: its number, n_bodies for the joints between bodies.
CrackEnergy& crack_energy_of(const Model&, State&, int body);

// A State at rest for the model: no displacement, contacts where the joint is not bonded.
State initial_state(const Model&);

// How many entries the field has in a State of the model; nothing where any number will do. A field of need `later` may
// be empty instead.
std::optional<std::size_t> entries_of(const FieldRow&, const Model&);

// Whether entries of an array are nothing but doubles, which can be looked through for numbers that are none.
template <class Entry>
inline constexpr bool is_all_doubles =
    !std::is_integral_v<Entry> && !std::is_same_v<Entry, Contact> && !std::is_same_v<Entry, OpenedContact> &&
    !std::is_same_v<Entry, FaceStateBatch> && !std::is_same_v<Entry, ExcavationForce>;
// The first field in which something is not a number; null: there is none. Batches of tets are left out, as lanes without
// a tet hold anything.
const char* field_with_nan(const State&);

// A field as bytes: for checkpoints and comparisons.
struct StateField {
  FieldRow row;
  void* data;
  std::size_t bytes; // of the whole array
  // For an array: sets its length in bytes; false if this is not a whole number of entries. Null for other fields.
  std::function<bool(std::size_t bytes)> resize = {};
};

// Every field, in the order of the table.
std::vector<StateField> fields(State&);

// FNV-1a over all fields, bit for bit.
std::uint64_t hash(const State&);

} // namespace cdem
