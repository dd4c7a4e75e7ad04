// What a Simulation is made of; only simulation*.cpp see it.
#pragma once

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/bond/water_work.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/load/gone_body.hpp"
#include "libcdem/procedure/catch_up.hpp"
#include "libcdem/ranks/state_shares.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/simulation.hpp"
#include "libcdem/step/stage.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

namespace cdem {

struct Simulation::Impl {
  Model model;
  State kept; // in a stage among several ranks: the share of this one, until somebody looks at more
  State last_good;
  Conditions conditions;
  RunLog log;
  std::shared_ptr<Observer> observer;
  int threads = 1;
  int stage = 0;
  bool in_stage = false; // which `stage` counts already
  double last_residual = 0;
  std::size_t watches = 0; // made by the script so far

  std::uint64_t built = 0; // hash of the model as it was built
  bool replaying = false;
  CheckpointWriter* checkpoints = nullptr;
  std::optional<RestartPoint> restart_point; // of the stage that runs
  std::optional<RestartPoint> from;          // of a restored stage, until it is taken up
  // Where the last run ended, with the state in last_good: a run that follows goes on from there, with the steps that the
  // last one chose, if it is to choose them in the same way. Null: something has been changed since, or solved otherwise.
  struct End {
    RestartPoint point;
    std::array<double, 4> step_choice{}; // of RunOptions: safety, time_step, mass_scaling
  };
  std::optional<End> end_of_run;
  std::string at_start; // saved before a stage that can be begun again only; empty: none runs

  std::set<std::string> told; // warnings that the user has
  void tell(const std::string& line);
  void warn_before_stage();
  void warn_of_loads_on_supports();
  void warn_of_held_records();
  void warn_of_lost_probes();
  void warn_of_dry_rock(const InitialStress&);
  void warn_of_distant_table(const std::shared_ptr<const WaterTable>&);
  void warn_of_open_water(const StillWater&);
  void warn_of_uneven_bed(const Flow&);
  void warn_of_unstressed_rock();
  void warn_of_welded_pieces(const Selection&);
  // Initial stresses that the script has given before the first stage, and the blocks of each.
  struct GivenStress {
    InitialStress field;
    std::vector<char> has; // of each block
  };
  std::vector<GivenStress> given_stress;
  void warn_of_stress_jumps();
  // Flows of water that has reached no face in any run so far; and those that have.
  struct FlowKey {
    const WaterField* water;
    std::string on;
    bool operator==(const FlowKey& other) const { return water == other.water && on == other.on; }
  };
  struct DryFlow {
    FlowKey flow;
    double begin; // s, of the first run
    std::string line;
  };
  std::vector<DryFlow> dry_flows;
  std::vector<FlowKey> wet_flows;
  void look_for_dry_flows(double begin, double end);
  std::optional<geom::Vec3> lowest_place(const Selection& outer_faces) const; // m; none on none
  void warn_of_falling_forces();

  // All ranks call these together.
  const State& whole() {
    make_whole(kept);
    return kept;
  }
  State& changing() {
    end_of_run.reset();
    make_whole(kept);
    return kept;
  }

  StageContext next_stage() {
    warn_before_stage();
    StageContext context =
        stage_context(model, kept, conditions, log, last_good, *observer, threads, ++stage);
    context.checkpoints = checkpoints;
    return context;
  }

  RestartPoint take_up(End);

  // Runs one stage, from where it was left if it was; a run from where the one before ended, if that may be.
  template <class Solve>
  auto run_stage(const Solve& solve, const std::array<double, 4>* step_choice = nullptr) {
    const struct Leave {
      Impl& s;
      ~Leave() {
        s.in_stage = false;
        if (s.restart_point) // else the stage was refused before it had begun, and nothing has changed
          s.end_of_run.reset();
        s.restart_point.reset();
      }
    } leave{*this};
    StageContext context = next_stage(); // asks functions of a script, from which the run may be stopped
    in_stage = true;
    context.restart_point = &restart_point;
    std::optional<RestartPoint> entry;
    entry.swap(from);
    if (entry)
      last_good = kept;
    else if (end_of_run && step_choice && end_of_run->step_choice == *step_choice)
      entry = take_up(std::move(*end_of_run));
    if (entry) {
      restart_point = entry;
      context.from = &*entry;
    }
    auto result = solve(context);
    if (step_choice)
      end_of_run = End{*std::exchange(restart_point, std::nullopt), *step_choice};
    return result;
  }

  // Runs one that is begun again when it was left, as it changes the model from step to step.
  template <class Solve>
  auto run_whole_stage(const Solve& solve) {
    if (checkpoints)
      at_start = saved();
    const struct Leave {
      Impl& s;
      ~Leave() { s.at_start.clear(); }
    } leave{*this};
    return solve(next_stage());
  }

  std::string saved() const;
  void take(std::string_view saved, bool state_only);

  // Takes one more condition, tried first, so that one that selects nothing changes nothing. It is tried alone: the
  // others were tried before, and thousands of calls take a time that grows with their number. Only what holds rigid
  // bodies must fit together.
  template <class Add>
  void add_condition(const Add& add) {
    end_of_run.reset();
    if (!replaying) {
      Conditions tried;
      if (!model.rigid.empty())
        tried.fixes = conditions.fixes;
      Conditions own;
      add(own);
      refuse_gone(model, own);
      add(tried);
      resolve(model, whole(), tried);
    }
    add(conditions);
  }

  void add_boundary(const Selection& on, const std::function<void(Conditions&)>& add); // of waves

  double stored_energy() { // callers change the whole state
    const State& state = kept;
    return elastic_energy(model, state) + spring_energy(model, state) + mesh_spring_energy(model, state);
  }

  // Cutting knows convex blocks only.
  void require_blocks(const char* call) const {
    if (!std::all_of(model.blocks.begin(), model.blocks.end(), [](const Block& b) { return b.convex(); }))
      throw geom::InputError(std::string(call) +
                             ": the model has meshed bodies; only a model of convex blocks alone "
                             "can be cut");
  }

  // Turns the selected blocks rigid or deformable.
  template <class Set>
  std::int64_t convert(const Selection& on, const Set& set) {
    std::vector<int> blocks;
    for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
      if (selects_block(model, on, b)) {
        if (!model.blocks[b].meshed)
          throw geom::InputError("on", on.text, "meshed bodies",
                                 "block " + std::to_string(model.blocks[b].id) +
                                     " is of small strain, which always deforms");
        blocks.push_back(b);
      }
    if (blocks.empty())
      throw geom::InputError("on", on.text, "a place that holds the centroids of meshed bodies",
                             "nothing of the model lies there");
    Model changed = model;
    State moved = whole();
    if (!replaying)
      catch_up_velocities(model, moved, conditions);
    const std::int64_t count = set(changed, moved, blocks);
    if (count == 0)
      return 0;
    if (!replaying)
      resolve(changed, moved, conditions); // a rigid body cannot be held in part
    model = std::move(changed);
    changing() = std::move(moved);
    last_good = kept;
    return count;
  }

  // A change of topology between stages: the ledger counts what it does to the stored and the kinetic energy.
  void adopt(Rebuilt&& rebuilt) {
    State& state = changing();
    const double before = cdem::energy(model, state).total(), water = water_work(model, state);
    model = std::move(rebuilt.model);
    state = std::move(rebuilt.state);
    state.spent.cutting += before - cdem::energy(model, state).total();
    state.spent.external += water - water_work(model, state);
    last_good = state;
  }
};

} // namespace cdem
