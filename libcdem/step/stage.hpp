// What relaxing and running share: the parts of a step that go over all chunks, and the watch over a stage.
#pragma once

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/parallel/thread_choice.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/step/escape.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/keeper.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/options.hpp"
#include "libcdem/step/soundness.hpp"
#include "libcdem/step/telling.hpp"

#include <chrono>
#include <functional>
#include <optional>

namespace cdem {

struct StageContext {
  const Model& model;
  State& state;
  const Conditions& conditions;
  RunLog& log;
  State& last_good; // copy of the state that last passed the watch
  Observer& observer;
  int threads = 1;
  int number = 0;                          // of the stage, from 1
  Keeper* keeper = nullptr;                // may be null
  std::optional<Moment>* moment = nullptr; // written by the stage: where it can be left; null: nowhere
  const Moment* from = nullptr;            // the stage goes on from here; the state is the one of that moment
  std::function<std::string()> beside{};   // Moment::beside as it is now; empty: a stage of one loop
};

// The stage can be left here, where none of its loops has begun a step: the state is kept, the Moment written anew.
void leave_from_here(const StageContext&);

// Steps between looks at every node and element, and between copies of the state.
inline constexpr std::int64_t watch_every = 200;
// Steps between looks at which broken faces have parted or slid away. Until then their own springs hold them: in a body
// that shatters every look would else be followed by a search for contacts.
inline constexpr std::int64_t hand_over_every = 20;
static_assert(watch_every % hand_over_every == 0,
              "a stage that goes on looks anew where it did when it was left");

class Stage {
public:
  // run_away: displacement that ends the stage with a SolutionError, m.
  Stage(const StageContext& context, std::string kind, double run_away);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  Workspace work;
  std::int64_t step = 0;                  // within the stage
  std::function<void(Progress&)> details; // adds to what the progress line shows; may be empty
  // Ends with a SolutionError where broken faces no longer stand for the pieces' contact.
  bool follows_pieces = false;
  EscapeLimits escapes; // where pieces have left the model

  // One step: all forces where the nodes are, and move(nodes, forces, sums) for every node once all that reads where it
  // is has done so; `forces` are those of elements and springs at `nodes`, the first first. The nodes of rigid bodies
  // move with them: move_rigid(rigid body, sums). Returns the sums over all chunks, added in order.
  template <class Move, class MoveRigid>
  NodeSums advance(bool breaking, const Move& move, const MoveRigid& move_rigid);
  // Contacts for where the nodes are; before advance. Returns the longest step that they leave, s, `safety` times the
  // stable one; infinite without contacts. Throws SolutionError when something has gone too deep.
  double meet(double safety = 1);
  // Everything moved on by this long (s; steps of unit length in a relaxation).
  void moved(double time_step);
  // Brings the stress of meshes up to where the nodes are; before a state is kept or handed out.
  void catch_up();

  // The same for those who only look, as long as this lives; then bonds are as they were. Brought up twice, in this
  // step and in the next, they would break with other energies, and slide to other places in the last digit.
  class Look {
  public:
    explicit Look(Stage&);
    ~Look();
    Look(const Look&) = delete;
    Look& operator=(const Look&) = delete;

  private:
    Stage& stage_;
    double strain_step_ = 0; // s; 0: nothing to put back
    bool contact_due_ = false, pieces_due_ = false;
    std::vector<StressBatch> stress_, viscous_stress_;
    std::vector<FaceStateBatch> faces_;
    std::vector<FaceSlip> face_slip_;
    EnergyLedger spent_;
  };

  // True at the head of a step before which the state has been kept: mark() there, with what the loop carries.
  bool can_be_left() const { return context_.moment && step > 0 && step % watch_every == 0; }
  void mark(std::vector<double> carried, const std::vector<Node>& previous_force = {});

  // Bookkeeping after a step: ledger, breaks, history, progress, soundness, stop. Throws SolutionError, Interrupted.
  struct StepReport {
    NodeSums sums;
    double residual = 0;
    Progress goals; // residual_goal, time_start, time_goal, max_steps
  };
  void after_step(const StepReport&);
  StageResult finish(const StepReport&); // last history row and progress
  std::int64_t broken_in_step() const { return broken_in_step_; }

private:
  NodeSums total() const;
  double wall_time() const; // s
  StageStep here() const { return {context_.number, kind_, step}; }
  void meet_contacts();
  void catch_up_contacts();
  void catch_up_meshes();
  void keep_state();
  void look_for_escapes();        // the state is caught up
  void sample(const StepReport&); // a row of the history
  void tell(const StepReport&, bool last);

  StageContext context_;
  ThreadChoice threads_;
  std::vector<double> rigid_reach_; // m, reaches_of_rigid
  std::vector<double> row_sums_;    // N/m, of elements and bonds (n_nodes); empty without contacts
  std::string kind_;
  double run_away_;
  std::int64_t broken_in_step_ = 0;
  std::size_t contacts_before_ = 0;
  ContactSums met_; // the deepest since the head of the last step
  std::int64_t broken_tension_before_ = 0, broken_shear_before_ = 0;
  std::chrono::steady_clock::time_point start_;
  Telling telling_;
};

template <class Move, class MoveRigid>
NodeSums Stage::advance(bool breaking, const Move& move, const MoveRigid& move_rigid) {
  const Model& model = context_.model;
  State& state = context_.state;
  work.hand_over_due = step % hand_over_every == 0;
  const auto springs = static_cast<std::int64_t>(model.point_chunks.size());
  const auto meshes = static_cast<std::int64_t>(model.mesh.chunks.size());
  const auto stars = static_cast<std::int64_t>(model.chunks.size()) - meshes;
  // Springs, and meshes with those of their nodes that only one chunk reads.
  for_chunks(springs + meshes, context_.threads, [&](std::int64_t c) {
    if (c < springs) {
      spring_forces(model, state, work.bond, model.point_chunks[c], work.bond.sums[c], breaking);
      return;
    }
    const MeshChunk& chunk = model.mesh.chunks[c - springs];
    if (chunk.stars || is_rigid(model, chunk))
      return;
    const Node* const force = mesh_forces(model, state, work, c - springs, breaking);
    NodeSums sums;
    move(Range{chunk.nodes.begin, chunk.inner_end}, force, sums);
    work.node_sums[stars + c - springs] = sums;
  });
  // Blocks, and the nodes that several chunks of a mesh read.
  for_chunks(stars + meshes, context_.threads, [&](std::int64_t c) {
    if (c < stars) {
      NodeSums sums;
      block_forces(model, state, work, model.chunks[c]);
      move(model.chunks[c].nodes, work.force.data() + model.chunks[c].nodes.begin, sums);
      work.node_sums[c] = sums;
      return;
    }
    const MeshChunk& chunk = model.mesh.chunks[c - stars];
    if (is_rigid(model, chunk))
      return;
    if (chunk.stars) { // its bonds have been computed
      NodeSums sums;
      const Node* const force = mesh_forces(model, state, work, c - stars, breaking);
      each_deformable_run(model, chunk,
                          [&](Range nodes) { move(nodes, force + (nodes.begin - chunk.nodes.begin), sums); });
      work.node_sums[c] = sums;
      return;
    }
    NodeSums sums = work.node_sums[c];
    ReadAhead ahead = shared_reads_of(model, state, work, c - stars + 1);
    ahead.spread(chunk.nodes.end - chunk.inner_end);
    each_shared_force(model.mesh, work, chunk, ahead,
                      [&](Range nodes, const Node* force) { move(nodes, force, sums); });
    work.node_sums[c] = sums;
  });
  work.strain_step = 0;
  if (const auto bodies = static_cast<std::int64_t>(model.rigid.size()); bodies > 0)
    for_chunks(bodies, context_.threads, [&](std::int64_t body) {
      NodeSums sums;
      move_rigid(static_cast<int>(body), sums);
      work.rigid_sums[body] = sums;
    });
  return total();
}

// Of the threads allowed, as many as the model keeps busy.
int useful_threads(const Model&, int threads);

// Out-of-balance over applied force norm; reactions stand in for the loads where supports move.
double relative_residual(const NodeSums&);

} // namespace cdem
