// Places of a stage where the model becomes another one: nodes of cohesive bodies are freed, interfaces that have slid get
// new springs. What is known of the model before is carried over or made anew, and the stage can be left there.
#include "libcdem/bond/release.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/fracture/renew_interfaces.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/stage.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cdem {
namespace {

// Per node, which it is now; -1: of a block whose nodes have been freed or joined.
std::vector<int> new_nodes_of_unchanged(const Model& before, const Model& now) {
  std::vector<int> new_node(before.node_position.size(), -1);
  for (std::size_t b = 0; b < before.blocks.size(); ++b) {
    const Block &old = before.blocks[b], &block = now.blocks[b];
    if (old.node_end - old.node_begin == block.node_end - block.node_begin)
      std::iota(new_node.begin() + old.node_begin, new_node.begin() + old.node_end, block.node_begin);
  }
  return new_node;
}

} // namespace

bool Stage::split_nodes(double time_step) {
  time_step_ = time_step;
  if (!breaking || watch_.empty() || !context_.changing)
    return false;
  const Model& model = context_.model;
  State& state = context_.state;
  const double ahead = 2 * time_step;
  if (!work.near.crack_known)
    watch_.look(model, state, work.part().mesh_chunks(), context_.threads, work.near);
  const bool rates_unknown = begins_ && step <= 1; // how stresses rise is known from velocities alone
  const std::vector<char> bodies =
      watch_.due(model, state, work.near, work.part().mesh_chunks(), context_.threads, ahead, rates_unknown);
  bool due = std::find(bodies.begin(), bodies.end(), 1) != bodies.end();
  std::vector<char> nodes;
  if (due) {
    synchronise_contacts(context_.log); // of the step to come, as their forces are not renumbered
    see_whole();
    nodes = watch_.to_free(model, state, bodies, context_.threads, ahead);
    due = std::find(nodes.begin(), nodes.end(), 1) != nodes.end();
  }
  if (due)
    change_nodes(cdem::split_nodes(model, std::move(state), nodes));
  progress_.times.end(StepLine::cracks);
  return due;
}

bool Stage::join_nodes() {
  if (!breaking || !in_real_time || watch_.empty() || !context_.changing || context_.renumbered ||
      !is_due(watch_every))
    return false;
  const Model& model = context_.model;
  State& state = context_.state;
  if (std::find(model.mesh.freed.begin(), model.mesh.freed.end(), 1) == model.mesh.freed.end())
    return false;
  const std::vector<char> nodes = watch_.to_join(model, state, work.part().mesh_chunks(), context_.threads);
  const bool any = std::find(nodes.begin(), nodes.end(), 1) != nodes.end();
  if (any) {
    synchronise_contacts(context_.log);
    see_whole();
    const double before = energy(model, state).total();
    strain_meshes(model, state, bring_together(model, state, nodes, work.strain_step), context_.threads);
    change_nodes(cdem::join_nodes(model, std::move(state), nodes));
    context_.state.spent.cutting += before - energy(model, context_.state).total();
  }
  progress_.times.end(StepLine::cracks);
  return any;
}

// Goes on with the model and state in which nodes have been freed or joined. A stop waits until that is done: functions of the
// script are asked which nodes conditions mean.
void Stage::change_nodes(Freed freed) {
  const Doing changes(&context_.observer, Activity::changing);
  const Model& model = context_.model;
  State& state = context_.state;
  const bool near_known = work.near.crack_known;
  const std::vector<std::uint8_t> near = near_of_all_ranks(work);
  const std::vector<int> slots = model.mesh.tet_slot;
  const FlowPatterns flows = flow_patterns(work.resolved);
  const std::vector<int> new_node = new_nodes_of_unchanged(model, freed.model);
  gather_carried();
  for (std::vector<Node>* of_nodes : carried) {
    const std::vector<Node> before = std::move(*of_nodes);
    of_nodes->clear();
    for (const int node : freed.old_node)
      of_nodes->push_back(before[node]);
  }
  renew_row_sums(model, freed.model, freed.old_node, freed.tets);
  *context_.changing = std::move(freed.model);
  state = std::move(freed.state);
  if (scale_masses)
    scale_masses();
  if (context_.renumbered)
    context_.renumbered(freed.old_node);
  Workspace before = std::move(work);
  try {
    work = Workspace(model, state, context_.conditions);
  } catch (...) { // such a function has failed: what is written then is of this model
    context_.last_good = state;
    throw;
  }
  keep_flow_patterns(flows, new_node, work.resolved);
  work.damped = before.damped;
  work.strain_step = before.strain_step;
  work.bond = std::move(before.bond);
  for (std::size_t i = 0; i < work.bond.laws.size(); ++i) // of the new Model
    work.bond.laws[i] = law_of_interface(model, model.interfaces[i]);
  work.contact = std::move(before.contact);
  watch_.freed(model);
  work.watch = &watch_;
  tets_by_place_ = nullptr;
  shares_.loads_are_whole();
  shares_.share(moving());
  if (near_known) {
    std::vector<std::uint8_t> now(model.mesh.batches.size(), 0);
    for (std::size_t tet = 0; tet < slots.size(); ++tet)
      now[model.mesh.tet_slot[tet] / lanes] |= near[slots[tet] / lanes];
    take_near_of_all(std::move(now), work);
  }
  contacts_ = ContactUpdate(context_);
  contacts_.start_anew(model, state, work.contact, false);
  place_water();
  update_external(work.resolved, state.time, moving());
  if (std::find(freed.anew.begin(), freed.anew.end(), 1) == freed.anew.end())
    return;
  const BondWork bond = work.bond; // what springs lose in the step to come begins with the one before
  preload_faces(model, state, net_forces(model, state, work, context_.threads, freed.anew), freed.anew);
  work.bond = bond;
  work.near.forget_pulls(model); // those of the net forces are of another moment
  contacts_.start_anew(model, state, work.contact, true);
}

BegunCracks Stage::begun_cracks() {
  const Model& model = context_.model;
  State& state = context_.state;
  const Range chunks = work.part().mesh_chunks();
  if (!work.near.crack_known)
    watch_.look(model, state, chunks, context_.threads, work.near);
  const CrackingStep cracking{work.strain_step, time_step_, in_real_time, context_.threads};
  BegunCracks begun = cdem::begin_cracks(model, state, watch_, work.near, chunks, cracking);
  share_reliefs(begun);
  relieve(model, state, begun, chunks, cracking);
  work.shared->share_faces(state);
  return begun;
}

bool Stage::renew_interfaces() {
  if (slid_.empty() || !context_.changing)
    return false;
  const Model& model = context_.model;
  State& state = context_.state;
  synchronise_contacts(context_.log);
  see_whole();
  gather_carried();
  BondWork before = std::move(work.bond);
  shares_.gather(before);
  for (const int i : slid_)
    state.spent.friction += catch_up(model, state, before, model.interfaces[i]);
  const RenewedInterfaces renewed =
      cdem::renew_interfaces(*context_.changing, state, std::exchange(slid_, {}), context_.threads);
  state.spent.friction += renewed.lost;
  state.spent.external += renewed.water;
  work.bond = BondWork(model, state);
  start_spring_forces(model, state, work.bond);
  for (std::size_t p = 0; p < renewed.old_point.size(); ++p)
    if (const int old = renewed.old_point[p]; old >= 0) {
      work.bond.spring_force[p] = before.spring_force[old];
      if (!work.bond.stretch.empty())
        work.bond.stretch[p] = before.stretch[old];
      if (!work.bond.viscous.empty())
        work.bond.viscous[p] = before.viscous[old];
    }
  if (scale_masses)
    scale_masses();
  shares_.loads_are_whole();
  shares_.share(moving());
  contacts_ = ContactUpdate(context_);
  contacts_.start_anew(model, state, work.contact, true);
  progress_.times.end(StepLine::bonds);
  return true;
}

} // namespace cdem
