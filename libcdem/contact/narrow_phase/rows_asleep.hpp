// Which rows are computed in a step, and which are skipped.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes RowsAsleep::awake, and the motion of the rigid pairs whose rows are awake.
void find_awake(const Model&, const State&, ContactWork&);

// The movers of a row's targets. visit: takes the number of one.
template <class Visit>
void each_mover(const ContactWork& work, const ContactRow& row, const Visit& visit) {
  if (!row.several_movers) {
    visit(row.mover);
    return;
  }
  int last = -1; // triangles stand by block
  for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
    const int mover = work.movers.of_triangle[work.rows[Contact::spring].candidates[i].target];
    if (mover != last)
      visit(mover);
    last = mover;
  }
}

// m, since the search: what recheck distances of a row of no rigid pair are compared with. No target comes nearer to the
// source than by its increase.
inline double travelled(const ContactWork& work, const ContactRow& row) {
  double sum = work.motion.travelled[row.source_mover];
  each_mover(work, row, [&](int mover) { sum += work.motion.travelled[mover]; });
  return sum;
}

// Whether a row whose movers have travelled far enough to be looked at may sleep on, since they did so together.
bool sleeps_on(const ContactWork&, const ContactRow&, float& recheck_distance);

// After it has been looked at, of a row that is of no rigid pair. blocks: in the model.
void fall_asleep(const ContactWork&, int blocks, ContactRow&, float& recheck_distance);

} // namespace cdem
