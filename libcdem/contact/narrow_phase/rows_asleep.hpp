// Which rows are computed in a step, and which are skipped.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"

namespace cdem {

// Writes RowsAsleep::awake.
void find_awake(const ContactWork&, RowsAsleep&);

// Whether a row whose movers have travelled far enough to be looked at may sleep on, since they did so together.
bool sleeps_on(const ContactWork&, const ContactRow&, float& recheck_distance);

// After it has been looked at. blocks: in the model.
void fall_asleep(const ContactWork&, int blocks, ContactRow&, float& recheck_distance);

} // namespace cdem
