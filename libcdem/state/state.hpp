// State: every array that changes while stepping, with its meaning, unit, size and writer in one registry that
// drives the hash, the carrying over at cuts, the watch for NaN and checkpoints.
#pragma once

#include "libcdem/bolt/bolt.hpp"
#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/joint/joint_spring.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/cohesive_face.hpp"
#include "libcdem/state/contact.hpp"
#include "libcdem/state/crack_energy.hpp"
#include "libcdem/state/face_state.hpp"
#include "libcdem/state/ledger.hpp"
#include "libcdem/state/rigid_state.hpp"
#include "libcdem/state/stress_batch.hpp"
#include "libcdem/state/tet_contact.hpp"

#include <functional>
#include <memory>

namespace cdem {

class StateShares; // ranks/state_shares.hpp

// Per node: its piece is inside the model, has left it (a warning has named it), or is held where it was then.
enum class Escaped : std::uint8_t { inside, told, held };

struct State {
  double time = 0;       // s; written by run
  std::int64_t step = 0; // over all stages; written by end_step
  // s, velocities and the summed energies stand this long before the displacements; written by run, relax
  double velocity_lag = 0;

  std::vector<Node> displacement; // m (n_nodes); written by step_nodes, relax_nodes, move_rigid
  std::vector<Node> velocity;     // m/s, velocity_lag behind (n_nodes); likewise
  std::vector<geom::Vec3>
      bond_offset; // m, relative displacement without traction: preload and slip (n_points)
  std::vector<std::uint8_t>
      bond_mode; // BondMode (n_points); bond_offset and bond_mode: written by spring_forces
  // For bonds that soften (joint/softening.hpp), written by spring_forces; empty if no joint of the model softens.
  std::vector<double> bond_damage; // D, 0 whole .. 1 separated (n_points)
  std::vector<geom::Vec3>
      bond_slip; // m, slip of the damaged part, added to bond_offset at separation (n_points)
  // For springs whose joint has a law (joint/joint_law.hpp), written by spring_forces; empty if no joint has one.
  std::vector<JointHistory> joint_history; // (n_points)
  // m, in the interface's undeformed directions, by which side b had slid past side a when the faces were last
  // intersected anew (n_points); for results only; empty until that happens; written by renew_interfaces
  std::vector<geom::Vec3> slid_before;
  // Pa, of the water in joints, >= 0 (n_points); empty until there is some; written by set_water
  std::vector<double> water_pressure;
  // 1: the interface has parted or slid away and is left to contact (n frames); written by release_interfaces
  std::vector<std::uint8_t> released;
  std::vector<Stress>
      initial_stress; // Pa, of blocks of small strain (n small_strain_tets); written by initial_stress
  // For meshed bodies.
  std::vector<StressBatch> stress; // Pa (n mesh batches); written by mesh_forces
  // Pa, of the strain rate, beside it; as long, or empty where no material has stiffness damping.
  std::vector<StressBatch> viscous_stress;
  // Equivalent plastic strain (material/plasticity.hpp), as long; empty without plastic bodies; written by mesh_forces
  std::vector<PlasticStrainBatch> plastic_strain;
  std::vector<FaceStateBatch> faces; // (n face batches); written by mesh_forces
  // m, of the batches of faces with a broken spring, eight faces each, in the order they broke; written by mesh_forces
  // and, where a spring has just broken, by record_face_breaks
  std::vector<FaceSlip> face_slip;
  // (n face batches * lanes); written by begin_cracks, mesh_forces; empty without cohesive bodies
  std::vector<CohesiveFace> cohesive;
  // DIF at which each face began to crack (joint/rate_effect.hpp), as long; empty where no joint has a rate effect;
  // written by begin_cracks
  std::vector<double> rate_factor;

  std::vector<Contact> contacts; // those that act, by kind, source and piece; written by contact_forces
  // Those between tetrahedra of one broken body, ascending; written by contact_forces
  std::vector<TetContact> tet_contacts;
  std::vector<RigidState> rigid; // (n rigid bodies); written by move_rigid, set_rigid
  // m, of the nodes of rigid bodies from their centroids in the directions they were made rigid in (n_nodes); empty
  // without rigid bodies; written by set_rigid
  std::vector<Node> rigid_offset;

  // kg, what moves in a stage whose masses are scaled (n_nodes); empty: Model::node_mass; written by run
  std::vector<double> moving_mass;

  // Escaped (n_nodes); empty until something has left the model; written by find_escapes
  std::vector<std::uint8_t> escaped;

  // N, forces of supports that quiet boundaries have taken the place of (n_nodes); empty without; written by quiet,
  // free_field
  std::vector<Node> support_force;
  // m, m/s, motion of the columns of free fields, level by level from the foot, one column after the other; empty
  // without; written by advance_columns
  std::vector<Node> column_displacement, column_velocity;

  std::vector<BoltNode>
      bolts; // nodes of all bolts, in the order they were set; written by set_bolt, advance_bolts

  // m, what results take from the displacement: what it was when it was last set to zero (n_nodes); empty until then.
  // Mechanics never sees it; written by reset_displacement
  std::vector<Node> displacement_zero;
  // J, of each body, and last of the joints between bodies (n_bodies + 1); empty until something has broken; written by
  // record_bond_breaks, record_face_breaks, record_begun_cracks
  std::vector<CrackEnergy> crack_energy;

  EnergyLedger spent; // J, the summed entries only (damping, friction, ... external); the stored ones stay 0

  // With several ranks: how they share it, while each holds its own part only; null: it is whole. No field.
  std::shared_ptr<const StateShares> parted;
};

std::size_t small_strain_tets(const Model&); // the first so many tets of a model

// Displacement since it was last set to zero, m.
Node shown_displacement(const State&, int node);
const std::vector<double>& moving_mass(const Model&, const State&); // kg (n_nodes)

// The slip of a face's broken springs; zero slip is made room for when there is none yet.
FaceSlip& slip_of(State&, std::int64_t batch, int lane);
const FaceSlip* slip_of(const State&, std::int64_t batch, int lane); // null when there is none

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

// What an entry of the array belongs to. bond: a spring of an interface; frame: an interface that may turn; face, tet:
// of a mesh, eight side by side. body: of each, and one more for the joints between them. column: a level of
// one; bolt: a node of one.
enum class FieldPlace { model, node, bond, frame, block, tet, face, contact, rigid_body, body, column, bolt };

struct StateField {
  const char* name;
  const char* unit; // "record": an entry has members of several units, given where its struct is declared
  FieldPlace place;
  const char* writer; // the functions of a step that write it, or of a script where no step does
  void* data;
  std::size_t bytes; // of the whole array
  bool floating;     // made of doubles: watched for NaN
  // For an array: sets its length in bytes; false if this is not a whole number of entries. Null for other fields.
  std::function<bool(std::size_t bytes)> resize = {};
  bool shown_only = false; // says how results are shown, nothing about mechanics: no part of the hash
};

// Every field, in a fixed order.
std::vector<StateField> fields(State&);

// FNV-1a over all fields, bit for bit.
std::uint64_t hash(const State&);

} // namespace cdem
