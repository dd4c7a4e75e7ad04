// A stage: the steps of one loop of a solving call (step.cpp), and the watch over them. Between two steps, the stress of
// meshes and the contacts are a step behind the nodes. synchronise advances them; SynchronisedView does so for code that
// only reads the state.
#pragma once

#include "libcdem/fracture/begin_cracks.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/parallel/thread_choice.hpp"
#include "libcdem/step/contact_update.hpp"
#include "libcdem/step/escape.hpp"
#include "libcdem/step/kept_work.hpp"
#include "libcdem/step/options.hpp"
#include "libcdem/step/progress_reporter.hpp"
#include "libcdem/step/share_sums.hpp"
#include "libcdem/step/stage_shares.hpp"
#include "libcdem/step/timed_look.hpp"

#include <memory>

namespace cdem {

// All looks follow State::step, the steps of the model over all its stages: where a run ends and the next one goes on
// changes nothing. Steps between looks at every node and element, and between copies of the state:
inline constexpr std::int64_t watch_every = 200;
// Steps between looks at which broken faces have parted or slid away. Until then their own springs hold them: in a body
// that shatters every look would else be followed by a search for contacts.
inline constexpr std::int64_t hand_over_every = 20;
static_assert(watch_every % hand_over_every == 0,
              "a stage that goes on looks anew where it did when it was left");

class Procedure; // step.hpp

class Stage {
public:
  // run_away: displacement that ends the stage with a SolutionError, m.
  Stage(const StageContext& context, std::string kind, double run_away);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  Workspace work;
  std::int64_t step = 0; // within the stage
  std::function<void(Progress&)>
      details;                // adds to what the progress line shows, but stage, kind and times; may be empty
  bool breaking = true;       // bonds may break
  double safety = 1;          // the longest step over the stable one
  bool step_is_given = false; // by the user
  double stable = 0;          // s, the stable step as the procedure has found it; 0: it has not
  bool in_real_time = true;   // velocities are per second: strength may depend on the rate, nodes join again
  std::function<void()> scale_masses; // after nodes have been freed; may be empty
  // Ends with a SolutionError where broken faces no longer stand for the pieces' contact.
  bool follows_fragments = false;
  std::vector<std::vector<Node>*> carried; // by node, that the procedure carries beside the State
  EscapeLimits escapes;                    // where pieces have left the model
  std::vector<TimedLook> looks;            // after a step
  struct Report {
    NodeSums sums; // of the last step
    double residual = 0;
    Progress goals; // residual_goal, time_start, time_goal, max_steps
  };
  Report report;

  // The first row of the history: how things stand where the stage begins. Its residual comes with the first step, which
  // finds the forces there.
  void sample_start();

  bool begins() const { return begins_ && step == 0; }
  // After so many steps of the model there is a look.
  bool is_due(std::int64_t every) const { return context_.state.step % every == 0; }

  // Steps until the procedure is over. Throws SolutionError, Interrupted.
  void make_steps(Procedure&);
  // For procedures. s, for rigid bodies in flight (contact/response/contact_bounds.hpp); when contacts are known.
  double longest_step_of_flight(bool damped) const {
    return contacts_.longest_step_of_flight(context_, work, safety, damped);
  }
  // Pressures in cracks at this time. Returns the longest stable step, s, that pumped fluids leave to a mesh whose own is
  // `stable`.
  double update_crack_pressures(double stable);
  // Loads, supports that vary and free fields for the step that begins; null: of a relaxation, what follows the rock.
  void update_loads(const Stepping*);
  std::int64_t broken_in_step() const { return broken_.in_step; }

  // The end of the stage as a point from which another one may go on, which calls its first step 0. Before finish.
  void keep_end(std::vector<double> loop_state);
  // To the state that was kept last, after an error.
  void go_back();
  // In real time the water that moves with the nodes (load/water_forces.hpp) adds to their inertia; the kinetic energy
  // that changes with it is work of the water. Not beside scaled masses. water: kg (n_nodes); empty: none any more. At both ends
  // of a run: in between the steps take the water where it is.
  void carry_water(const std::vector<double>& water);
  StageResult finish(); // what results read, last history row and progress

  // The state of all ranks, for who looks at the whole of it, or at what a search for contacts reads and an array by node beside it.
  void see_whole();
  void gather_carried();
  void see_surfaces(std::vector<Node>& by_node); // where nodes are, and which bonds hold

  // Brings contacts and the stress of meshes up to where the nodes are; before a state is kept or handed out.
  void synchronise();

private:
  friend class SynchronisedView;

  Stage(const StageContext& context, std::string kind, double run_away,
        const std::shared_ptr<KeptWork>& kept);
  // end: of `kept`, from which the stage goes on; null: from none. kept: null where nothing is.
  Stage(const StageContext& context, std::string kind, double run_away, KeptWork* kept, KeptWork::End* end);

  void make_step(Procedure&);
  // Gives interfaces that have slid new springs (fracture/renew_interfaces.hpp). True when it has: the stable step is
  // another one, and the stage can be left here.
  bool renew_interfaces();
  // Frees the nodes whose time it is. True when it has: arrays by node are others now, the stable step is shorter, and the
  // stage can be left here. time_step: s, of the steps to come.
  bool split_nodes(double time_step);
  // Joins freed nodes where nothing has cracked and the body has come to rest. True when it has: arrays by node are others now,
  // the stable step may be longer, and the stage can be left here.
  bool join_nodes();
  bool can_be_left() const { return step > 0 && is_due(watch_every); }
  // Keeps the state and, where the stage may be left, the restart point that goes with it: both or neither.
  void keep_restart_point(std::vector<double> loop_state);
  // Returns the longest step that contacts leave, s; infinite without contacts. Throws SolutionError when something has
  // gone too deep.
  double update_contacts();
  void begin_forces();
  void begin_cracks(); // of cohesive bodies
  void bond_forces();
  void element_forces(Procedure&);
  void shared_node_forces(Procedure&);
  void rigid_bodies(Procedure&);
  void sum_up();
  void end_step(double time_step); // s; steps of unit length in a relaxation
  void watch();

  void take_springs(const RestartPoint&); // of its step
  void go_on_from(const RestartPoint&);
  void note(RestartPoint&, std::vector<double> loop_state) const;
  void require_sound_state(); // Throws SolutionError
  void keep_last_good();      // of this rank's share
  void keep_work();           // for the next stage
  void synchronise_contacts(RunLog&);
  std::int64_t synchronise_stress(RunLog&); // returns how many springs broke, of which the log is told
  BegunCracks begun_cracks();               // what share_sums sends
  void change_nodes(Freed);

  // m/s, of the nodes, for loads that depend on it; null in a relaxation, whose velocities are lengths per step.
  const std::vector<Node>* moving() const { return in_real_time ? &context_.state.velocity : nullptr; }
  StageStep here() const { return {context_.number, progress_.kind(), step}; }
  void place_water(); // forces of fields of water for where the faces stand
  void record_step(); // energies and breaks
  void release_parted_blocks();
  void look_over(); // the state is sound and up to date
  void look_at_sliding();
  void look_for_escapes(); // the state is caught up
  void sample();           // a row of the history
  void poll();             // stop, checkpoints, progress
  void tell(bool last);    // progress
  void show();             // to an observer who wants to see the model

  StageContext context_;
  std::shared_ptr<const TetsByPlace> tets_by_place_; // for probes; null: unknown
  bool sampled_start_ = false;                       // the last row of the history waits for its residual
  ThreadChoice threads_;
  ContactUpdate contacts_;
  StrengthWatch watch_;   // empty without cohesive bodies
  double time_step_ = 0;  // s, of the step to come
  double kick_ = 1;       // s, Stepping::kick of the step; 1 in a relaxation
  BegunCracks begun_;     // in this step
  std::vector<int> slid_; // interfaces to renew before the next step
  bool begins_ = true;    // no step of this stage, or of one that it goes on from, has been made before
  bool kept_end_ = false;
  bool contacts_as_kept_ = false; // none has been looked at since the end was kept
  struct Good { // Workspace::strain_step (s) and the log, as they were for the state that was kept last
    double strain_step = 0;
    std::size_t breaks = 0;
    OneWayEnergies one_way;
  } good_;
  double run_away_;
  bool breaking_ = false; // in the last step
  struct Broken {         // bonds; between two steps: as faces were brought up to date
    std::int64_t in_step = 0, between = 0, tension_before = 0, shear_before = 0;
  } broken_;
  ProgressReporter progress_;
  StageShares shares_;
};

// Number of the allowed threads that the model keeps busy.
int useful_threads(const Model&, int threads);

// Out-of-balance over applied force norm; reactions stand in for the loads where supports move.
double relative_residual(const NodeSums&);
// What it is relative to, N2: squared norm of the loads, of the reactions where there are none.
double residual_reference2(const NodeSums&);

} // namespace cdem
