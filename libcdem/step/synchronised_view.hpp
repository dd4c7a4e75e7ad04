// A stage between two steps, for code that only reads it. While this object lives, contacts and the stress of meshes
// belong to the present positions of the nodes. Contacts stay there: the next step would begin with the same search and the same
// forces. What was written to bring the stress there is put back, bit for bit: the fields that the table of State marks as
// advancing, and the stage's own notes. So a step never knows that code has looked.
#pragma once

#include "libcdem/step/stage.hpp"
#include "libcdem/step/timed_look.hpp"

namespace cdem {

class SynchronisedView {
public:
  // With several ranks the State is whole, or each has its share: who reads more makes it whole (make_whole).
  enum class Of { whole, shares };
  SynchronisedView(Stage&, Of);
  ~SynchronisedView();
  // After code of others has read the state: with several ranks it must have asked for the same on all (ranks/looks.hpp).
  void require_same_looks() const;
  SynchronisedView(const SynchronisedView&) = delete;
  SynchronisedView& operator=(const SynchronisedView&) = delete;

private:
  struct Kept; // what the stage was like
  Stage& stage_;
  std::unique_ptr<Kept> kept_; // null: nothing had to be brought up to date
};

// Those that are due after a step from one time of the model to another, s.
void look(Stage&, const std::vector<TimedLook>&, double from, double to);

} // namespace cdem
