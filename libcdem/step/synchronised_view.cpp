#include "libcdem/step/synchronised_view.hpp"

#include "libcdem/ranks/looks.hpp"
#include "libcdem/step/support_forces.hpp"

namespace cdem {
namespace {

void copy_advancing_fields(const State& from, State& to) {
  each_field(
      [](const FieldRow& row, const auto& source, auto& target) {
        if (row.looked == FieldLooked::advances)
          target = source; // arrays keep their places in memory: the step knows where they lie
      },
      from, to);
}

} // namespace

struct SynchronisedView::Kept {
  State state; // the advancing fields
  Searches search;
  bool contact_due;
  std::vector<FaceSums> face_sums;
  NearStrength near;
  double strain_step;
  bool hand_over_due;
};

SynchronisedView::SynchronisedView(Stage& stage, Of what) : stage_(stage) {
  State& state = stage.context_.state;
  Workspace& work = stage.work;
  stage.synchronise_contacts(stage.context_.log);
  if (work.strain_step > 0) {
    kept_ = std::make_unique<Kept>(Kept{{},
                                        work.contact.search,
                                        work.contact.due,
                                        work.face_sums,
                                        work.near,
                                        work.strain_step,
                                        work.hand_over_due});
    copy_advancing_fields(state, kept_->state);
  }
  RunLog of_view;
  stage.synchronise_stress(of_view);
  if (what == Of::whole)
    stage.see_whole();
  stage.context_.seen->contacts = &work.contact.loads;
}

void SynchronisedView::require_same_looks() const {
  agree_on_look(Look::ended);
}

SynchronisedView::~SynchronisedView() {
  stage_.context_.seen->contacts = nullptr;
  stage_.context_.seen->supports.reset();
  stage_.work.shared->look_at(stage_.context_.state);
  if (!kept_)
    return;
  State& state = stage_.context_.state;
  Workspace& work = stage_.work;
  work.contact.search = std::move(kept_->search);
  work.contact.due = kept_->contact_due;
  work.face_sums = std::move(kept_->face_sums);
  work.near = std::move(kept_->near);
  work.strain_step = kept_->strain_step;
  work.hand_over_due = kept_->hand_over_due;
  copy_advancing_fields(kept_->state, state);
  work.shared->parted(state); // of others, stresses are those of when they were last gathered
}

void look(Stage& stage, const std::vector<TimedLook>& looks, double from, double to) {
  for (const TimedLook& timed : looks)
    if (timed.due(stage.step, from, to)) {
      const SynchronisedView view(stage, SynchronisedView::Of::shares);
      timed.look();
      view.require_same_looks();
    }
}

} // namespace cdem
