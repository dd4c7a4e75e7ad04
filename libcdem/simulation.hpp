// A model that a script builds, loads and solves: the const Model, its State, the conditions, and the solving calls in
// order. This is the whole public face of libcdem for the script layer.
#pragma once

#include "libcdem/fracture/options.hpp"
#include "libcdem/joint/joint.hpp"
#include "libcdem/load/conditions.hpp"
#include "libcdem/load/excavation_options.hpp"
#include "libcdem/load/initial_stress.hpp"
#include "libcdem/load/water.hpp"
#include "libcdem/material/elastic.hpp"
#include "libcdem/model/bonding.hpp"
#include "libcdem/model/element.hpp"
#include "libcdem/procedure/critical_flow_options.hpp"
#include "libcdem/procedure/grow_options.hpp"
#include "libcdem/procedure/reduce_strength.hpp"
#include "libcdem/procedure/settle_options.hpp"
#include "libcdem/results/cracks.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/results/fragment_motions.hpp"
#include "libcdem/results/j_integral.hpp"
#include "libcdem/results/joints.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/results/picture_snapshot.hpp"
#include "libcdem/results/slivers.hpp"
#include "libcdem/results/snapshot.hpp"
#include "libcdem/results/unbalance.hpp"
#include "libcdem/state/state.hpp"
#include "libcdem/step/checkpoint_writer.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/observer.hpp"
#include "libcdem/step/options.hpp"
#include "libgeom/assembly/assembly.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace cdem {

struct SlidingFriction; // step/sliding_friction.hpp

// The law of an interface whose centroid lies there (undeformed, m).
using JointAt = std::function<Joint(const geom::Vec3&)>;

// Convex blocks (shape), or meshes. Each connected part of a mesh becomes one block of tetrahedra.
struct BodySpec {
  std::string name; // unique; "body_1", ... when the user gives none
  geom::Assembly shape;
  Elastic material;
  Joint joint; // between the body's own blocks; of a meshed body on the inner faces that `bonding` names
  std::vector<geom::TetMesh> meshes = {};
  Bonding bonding = {};
  Element element = Element::finite_volume; // small_strain: of blocks only
  double zone_size = 0;        // m, edge length of the tets inside each convex block; 0: its star mesh
  RegionLaws region_laws = {}; // of meshes
  // For blocks: laws on faces by the joint set or cut that made them. All other faces have `joint`.
  std::map<std::string, Joint> set_joints = {};
  // For blocks: laws that vary with position. They replace `joint` and set_joints, which still apply to faces that are
  // cut later and to blocks that meet new neighbours.
  JointAt joint_at = {};
  std::map<std::string, JointAt> set_joints_at = {};
  PlasticLaws plasticity = {}; // of a body that moves far; empty: elastic
};

struct PairSpec {
  std::string body_a, body_b; // may be equal for none: a body's own joint stands in BodySpec
  Joint joint;                // between touching faces of the two bodies
};

struct ModelSpec {
  std::vector<BodySpec> bodies;
  std::vector<PairSpec> pairs = {}; // two bodies that touch and are not named here have the default
  // The law between all pairs of bodies that are not named, and of a meshed body with itself. Without it two bodies
  // that touch and are not named: geom::InputError.
  std::optional<Joint> default_contact = {};
};

struct ModelCounts {
  std::int64_t bodies = 0, blocks = 0, nodes = 0, tets = 0, interfaces = 0, bonds = 0;
  // bonds: spring points; each stands in exactly one of the following
  std::int64_t intact = 0, broken_tension = 0, broken_shear = 0, contacts = 0;
  std::int64_t damaged = 0; // of the intact ones: have begun to soften
};

struct ContactSummary {           // of meshed bodies
  std::int64_t acting = 0;        // now
  double deepest = 0;             // m, of all stages
  double deepest_over_height = 0; // over the height of the lower tet
};

class Simulation {
public:
  // Validates and builds; throws geom::InputError.
  Simulation(const ModelSpec&, int threads, std::shared_ptr<Observer>);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  // Another one in the same state with the same conditions, at its stage 0, without histories. Not in a stage.
  Simulation copy() const;

  // Conditions; each throws geom::InputError when it selects nothing or a value cannot be used.
  void fix(const Fix&);
  void release(const Selection&, std::array<bool, 3> axes); // undo fixes there
  // True when it acts on faces or nodes that an earlier one of its kind loads: they add up.
  bool traction(const Traction&);
  bool force(const PointForce&);
  void gravity(const Gravity&);
  // Each takes the place of a fix of the same place: what this holds stays as a load (State::support_force).
  void quiet(const Quiet&);
  void free_field(const FreeField&);
  bool flow(const Flow&); // true when it meets faces that an earlier one meets: their pressures add up
  void crack_pressure(const CrackPressure&);
  void clear_loads(); // tractions, forces, gravity, flows and pressures in cracks
  // Stress present before anything moves (load/initial_stress.hpp). Returns what it loads beyond its strength.
  BeyondStrength initial_stress(const InitialStress&);
  void initial_stress(const Selection&, const std::array<double, 6>&); // Pa, the same in all selected blocks
  WaterInJoints water(const Water&);                                   // load/water.hpp
  // Results count the displacement from here on; mechanics goes on as before.
  void reset_displacement();
  // The motion of a rigid body, given to all that is selected: v + w x (x - about), m/s and rad/s; about: m, where it
  // is now, the centroid of what is selected unless given. A rigid body takes it as a whole.
  void initial_velocity(const Selection&, const geom::Vec3& velocity,
                        const geom::Vec3& angular_velocity = geom::Vec3::Zero(),
                        const std::optional<geom::Vec3>& about = {});
  // Selected meshed blocks keep their shape from now on, or deform again; the ledger counts the kinetic energy of
  // deformation that is lost. Each returns how many changed.
  std::int64_t make_rigid(const Selection&);
  std::int64_t make_deformable(const Selection&);
  // Selected blocks (by centroid; by a face on a side) are taken out, with their bonds. What they did to the rock that
  // stays goes as the excavation says (load/excavation.hpp). Returns how many.
  std::int64_t remove(const Selection&, const Excavation& = {});
  // Forces of earlier excavations that are still kept go as told: `relaxed` counts from the beginning. Forces that are
  // relaxed further stay so. Returns how many go; throws geom::InputError where all that are kept are relaxed further.
  std::size_t relax_excavation(const Excavation&);
  double
  excavation_kept() const; // largest share of the forces of an excavation that acts now; 0: none is kept
  // Bonds whose point is selected are broken from now on (a notch); returns how many. whole_faces: only those of
  // interfaces that are selected with all their points, so that faces which meet the notch at its tip stay bonded.
  std::int64_t break_bonds(const Selection&, bool whole_faces = false);

  // Divides strengths by a factor (procedure/reduce_strength.hpp).
  void reduce_strength(double factor, const StrengthKinds&);

  // Watches the units (blocks) of a meshed body from now on, in every stage (results/watch.hpp). Returns the watch's
  // number, from 0; a resumed script that makes it again gets the one that was saved.
  std::size_t watch(const std::string& body, double leaves);

  // What a check, which solves nothing, asks before a stage: what a stage warns of as it begins; and the functions of time
  // and the fields of water at times of a run, s. Throw geom::InputError as the stage would.
  void check_stage();
  void check_run(double begin, double end);

  // Solving calls. Each is a numbered stage. SolutionError, Interrupted as in step/errors.hpp.
  RelaxResult relax(const RelaxOptions&);
  RunResult run(const RunOptions&);
  std::vector<BlockCut> refine(const RefineOptions&);
  GrowResult grow(const GrowOptions&);                          // one stage; see procedure/grow.hpp
  SettleResult settle(const SettleOptions&);                    // one stage; see procedure/settle.hpp
  CriticalFlowResult critical_flow(const CriticalFlowOptions&); // one stage; see procedure/critical_flow.hpp

  // What it is made of, for the functions of results/. The state is that of all ranks, who call this together.
  const Model& model() const;
  const State& state() const;
  const Conditions& conditions() const;
  const RunLog& log() const;
  const SlidingFriction& sliding() const;

  // Results.
  ModelCounts counts() const;
  ContactSummary contacts() const;
  double time() const;     // s
  double residual() const; // out-of-balance force norm over applied force norm
  Unbalance unbalance(std::optional<double> reference = {}) const; // results/unbalance.hpp
  double stable_time_step() const;                                 // s
  double rigid_time_step(const std::string& body) const; // s, that its units would take as rigid bodies
  int stage() const;                                     // solving calls so far
  std::int64_t steps() const;                            // steps of all stages
  EnergyLedger energy() const;
  std::uint64_t state_hash() const;     // of every State field, bit for bit
  std::vector<Slivers> slivers() const; // results/slivers.hpp
  // Pairs of bodies, by name, for which a law was given and that had neither interface nor contact so far; twice the same
  // body: its own blocks.
  std::vector<std::array<std::string, 2>> unmet() const;
  // There is something that could move the model: a load, a support that moves it, an initial stress or velocity, or
  // a state that is deformed already.
  bool anything_acts() const;
  // Flows of water that has reached no face in any run so far, in words.
  std::vector<std::string> dry_flows() const;
  std::vector<Fragment> fragments() const;              // largest first
  std::vector<FragmentMotion> fragment_motions() const; // the same, with their motion

  // Fields by name with a component: "displacement.x|y|z|magnitude", "velocity.*" at nodes; "stress.xx".., "von_mises",
  // "principal_stress.1..3" (tension positive, 1 the largest) as block averages. Unknown name: geom::InputError that
  // names the nearest right one. A selection that is met by nothing: geom::InputError.
  FieldValue max(const std::string& field, const Selection& = {}) const;
  FieldValue min(const std::string& field, const Selection& = {}) const;
  // Mean of a field of nodes over the outer faces on a side or plane that has some, else over the volume; mean of a
  // field of blocks over the volume.
  double mean(const std::string& field, const Selection& = {}) const;
  double at(const std::string& field,
            const geom::Vec3& place) const;    // interpolated in the block that holds place
  geom::Vec3 reaction(const Selection&) const; // N, force of the supports on the selected nodes

  // One row per block: id, parent, generation, centroid, volume, displacement of the centroid, stress.
  struct BlockRow {
    std::int64_t id, parent;
    int generation;
    std::string body;
    geom::Vec3 centroid, displacement;
    double volume;
    std::array<double, 6> stress;
  };
  std::vector<BlockRow> blocks() const;
  // From 0, the value of field "body". geom::InputError of `field`: there is none.
  int body_number(const std::string& body, const std::string& field = "body") const;

  // Joints between blocks (results/joints.hpp): sums by set; their surface with the outline of the bodies.
  std::vector<JointSum> joints(const JointChoice&) const;
  Snapshot joint_picture(const JointChoice&, const std::string& title) const;

  // Cracks: area and energy; the energy release rate.
  CracksByBody cracks() const;
  // Samples the force of the supports on a side or body, and the momentum of a body, into the history as columns name_x,
  // name_y, name_z.
  void record_reaction(const std::string& name, const std::string& on);
  void record_momentum(const std::string& name, const std::string& body);
  // Sets a bolt into the rock as it stands now (load/bolts.hpp).
  void bolt(const Bolt&);
  struct BoltRow {
    int bolt = 0, node = 0;                // from 1, from the collar on
    geom::Vec3 place = geom::Vec3::Zero(); // m, undeformed
    double tension = 0; // N, mean of the segments at the node; of the plate at a collar with one
    double grout = 0;   // N, on the rock, towards the far end
    double slip = 0;    // m, of the bolt past the grout
    double yielded = 0; // strain of the next segment that stays
  };
  std::vector<BoltRow> bolts() const;
  // Samples crack_quantities() of a body, or of all where it is empty, into the history as columns name_area ...
  void record_cracks(const std::string& name, const std::string& body);
  // JFront::body is taken from `body`; empty: the only one there is.
  JIntegral j_integral(const std::string& body, JFront, const std::vector<JDomain>&) const;
  const Elastic& material(const std::string& body) const;

  // A value sampled into the history: field at a place.
  void probe(const std::string& name, const std::string& field, const geom::Vec3& place);

  // Everything but the conditions, as bytes for a file: of a model that is idle as it is, in a stage as it was where
  // the stage can be left. The Model itself is among it only where it is no longer the one that was built.
  std::string save() const;
  // With several ranks, before rank 0 alone saves: brings it what the others hold. All of them call it.
  void gather_to_save();
  // On a Simulation built from the same ModelSpec; throws geom::InputError on another. A stage that was left is
  // begun again by the next solving call, which must be the same, and goes on where it was left.
  void restore(const std::string& saved);
  // Takes the state, with what broke on the way to it and how large its energies were: neither histories nor stages.
  void restore_state(const std::string& saved);
  // Who is asked for checkpoints during solving calls; must outlive them. Null: nobody.
  void set_checkpoint_writer(CheckpointWriter*);
  // While a script is replayed up to its checkpoint conditions are taken without being tried: the model they were
  // meant for is not there yet.
  void set_replaying(bool);

  // With several ranks, in a callback: rank 0 alone sees the whole model while what this returns lives, and the others
  // look at nothing. All of them call it.
  std::shared_ptr<void> show_lead() const;

  Snapshot snapshot(const std::string& title, const WaterWish& = {}) const;
  // What a picture shows. Among several ranks all call it, and the first alone gets values.
  Snapshot picture_snapshot(const PictureWish&, const std::string& title) const;
  // The last state that passed the checks before a SolutionError.
  Snapshot last_good_snapshot(const std::string& title) const;

private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl>);
  std::unique_ptr<Impl> impl_;
};

} // namespace cdem
