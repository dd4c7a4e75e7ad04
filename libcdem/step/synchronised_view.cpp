#include "libcdem/step/synchronised_view.hpp"

#include "libcdem/ranks/looks.hpp"

namespace cdem {

SynchronisedView::SynchronisedView(Stage& stage, Of what) : stage_(stage) {
  stage.synchronise_contacts();
  const State& state = stage.context_.state;
  if (!state.faces.empty() && stage.work.strain_step > 0) {
    strain_step_ = stage.work.strain_step;
    contact_due_ = stage.work.contact.due;
    pieces_due_ = stage.work.contact.fragments_due;
    stress_ = state.stress;
    viscous_stress_ = state.viscous_stress;
    plastic_strain_ = state.plastic_strain;
    faces_ = state.faces;
    contacts_ = state.contacts;
    tet_contacts_ = state.tet_contacts;
    faces_changed_ = stage.work.contact.faces_changed;
    face_slip_ = state.face_slip;
    cohesive_ = state.cohesive;
    crack_energy_ = state.crack_energy;
    spent_ = state.spent;
  }
  RunLog of_view;
  stage.synchronise_stress(of_view);
  if (what == Of::whole)
    stage.see_whole();
}

void SynchronisedView::require_same_looks() const {
  if (stage_.shared_)
    agree_on_look(Look::ended);
}

SynchronisedView::~SynchronisedView() {
  if (stage_.shared_)
    stage_.shared_->look_at(stage_.context_.state);
  if (strain_step_ == 0)
    return;
  State& state = stage_.context_.state;
  stage_.work.strain_step = strain_step_;
  stage_.work.contact.due = contact_due_;
  stage_.work.contact.fragments_due = pieces_due_;
  state.stress = stress_; // copied: the step knows where these lie
  state.viscous_stress = viscous_stress_;
  state.plastic_strain = plastic_strain_;
  state.faces = faces_;
  state.contacts = contacts_;
  state.tet_contacts = tet_contacts_;
  stage_.work.contact.faces_changed = faces_changed_;
  state.face_slip = face_slip_;
  state.cohesive = cohesive_;
  state.crack_energy = crack_energy_;
  state.spent = spent_;
  if (stage_.shared_) { // of others, stresses are those of when they were last gathered
    stage_.shared_->parted(state);
    stage_.shared_->part_contacts(state);
  }
}

} // namespace cdem
