// Which rows are computed in a step, and which are skipped.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes RowsAsleep::awake, and the motion of the rigid pairs whose rows are awake.
void find_awake(const Model&, const State&, ContactWork&);

// The blocks of a row's targets. visit: takes the number of one.
template <class Visit>
void each_target_block(const Model& model, const ContactWork& work, const ContactRow& row,
                       const Visit& visit) {
  if (!row.several_blocks) {
    visit(row.block);
    return;
  }
  int last = -1; // triangles stand by block
  for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
    const int block = model.surface.triangles[work.rows[Contact::spring].candidates[i].target].block;
    if (block != last)
      visit(block);
    last = block;
  }
}

// m, since the search: what recheck distances of a row of no rigid pair are compared with. No target comes nearer to the
// source than by its increase.
inline double travelled(const Model& model, const ContactWork& work, const ContactRow& row) {
  double sum = work.travel.travelled[row.source_block];
  each_target_block(model, work, row, [&](int block) { sum += work.travel.travelled[block]; });
  return sum;
}

// Whether a row of several blocks, of which find_awake knows no more than that, may sleep on.
inline bool sleeps_on(const Model& model, const ContactWork& work, const ContactRow& row) {
  return row.several_blocks && travelled(model, work, row) < row.recheck_distance;
}

} // namespace cdem
