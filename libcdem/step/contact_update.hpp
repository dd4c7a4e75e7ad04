// The contacts of a step. They are found and evaluated for the present positions of the nodes before the other parts of
// the step, and again when the state is read between two steps.
#pragma once

#include "libcdem/step/soundness.hpp"
#include "libcdem/step/stage_context.hpp"
#include "libcdem/step/workspace.hpp"

namespace cdem {

class ContactUpdate {
public:
  explicit ContactUpdate(const StageContext&);

  // The forces of contacts, and what they spend; the log is told of depths and of bodies that have met. Nothing is done
  // where nothing has moved since.
  void evaluate(const StageContext&, ContactWork&, RunLog&);
  // The longest step that the contacts evaluated last leave, s, `safety` times the stable one; infinite without
  // contacts. Throws SolutionError where one has gone too deep since the last call.
  double longest_step(const StageContext&, const Workspace&, double safety, bool given, const StageStep&);
  // The same for rigid bodies that are about to meet others: such that an impact keeps its energy.
  double longest_step_of_flight(const StageContext&, const Workspace&, double safety, bool damped) const;

  // As a stage that goes on: State::contacts holds all there are, and no fragment is new.
  static void go_on(ContactWork&);
  // As a stage that goes on from the end of the one that this and the work are of: what was found near is near.
  void go_on_from_end(const StageContext&, ContactWork&);
  // Contacts are looked for anew from here on, as by a stage that goes on from here: which pairs are skipped is not saved.
  // They have been evaluated for where the nodes are. The pairs of tetrahedra go on, as they change no force.
  // same_surfaces: those of before; what is known of rigid pairs goes on too.
  void start_anew(const Model&, const State&, ContactWork&, bool same_surfaces) const;
  // A stage may go on from here. All that is near is known, or is looked for anew.
  void pass_restart_point(const Model&, const State&, ContactWork&) const;

private:
  std::vector<double> row_sums_;          // N/m, of elements and bonds (n_nodes); empty without contacts
  std::vector<double> rigid_reach_;       // m, reaches_of_rigid
  std::vector<double> impact_frequency2_; // 1/s2, impact_frequencies2
  ContactSums deepest_;                   // since the last call of longest_step
  std::int64_t contacts_before_ = 0;
};

} // namespace cdem
