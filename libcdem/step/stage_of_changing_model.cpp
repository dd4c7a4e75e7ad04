// Places of a stage where the model becomes another one: nodes of cohesive bodies are freed, interfaces that have slid get
// new springs. What is known of the model before is carried over or made anew, and the stage can be left there.
#include "libcdem/bond/release.hpp"
#include "libcdem/fracture/renew_interfaces.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/stage.hpp"

#include <utility>

namespace cdem {

bool Stage::free_nodes() {
  if (freeing_.empty() || step % free_every != 0)
    return false;
  const Model& model = context_.model;
  State& state = context_.state;
  const auto due = freeing_.due(model, state, shared_.get(), context_.threads);
  if (due) {
    synchronise_to_leave();
    see_whole();
    Freed freed = cdem::free_nodes(model, state, *due);
    *context_.changing = std::move(freed.model);
    state = std::move(freed.state);
    if (scale_masses)
      scale_masses();
    if (context_.renumbered)
      context_.renumbered(freed.old_node);
    Workspace before = std::move(work);
    work = Workspace(model, state, context_.conditions);
    work.damped = before.damped;
    work.bond = std::move(before.bond);
    for (std::size_t i = 0; i < work.bond.laws.size(); ++i) // of the new Model
      work.bond.laws[i] = law_of_interface(model, model.interfaces[i]);
    work.contact = std::move(before.contact);
    gave_back_ = false;
    share();
    contacts_ = ContactUpdate(context_);
    contacts_.start_anew(model, work.contact, false);
    has_shared_nodes_ = has_shared_nodes(model);
    if (!scale_masses)
      carry_water();
    update_external(work.resolved, state.time, moving());
    preload_faces(model, state, net_forces(model, state, work), freed.anew);
    keep_last_good();
  }
  times_.end(StepLine::cracks);
  return due.has_value();
}

bool Stage::renew_interfaces() {
  if (slid_.empty() || !context_.changing)
    return false;
  const Model& model = context_.model;
  State& state = context_.state;
  synchronise_to_leave();
  see_whole();
  BondWork before = std::move(work.bond);
  if (shared_) {
    shared_->shares().gather_points(before.spring_force);
    shared_->shares().gather_points(before.stretch);
    shared_->shares().gather_points(before.viscous);
  }
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
  gave_back_ = false;
  share();
  contacts_ = ContactUpdate(context_);
  contacts_.start_anew(model, work.contact, true);
  keep_last_good();
  times_.end(StepLine::bonds);
  return true;
}

} // namespace cdem
