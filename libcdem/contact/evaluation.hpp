// What one source, a triangle with its three semi-springs or a semi-edge, does to what is near it.
#pragma once

#include "libcdem/contact/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Adds the contacts of the rows, as they are after the step, with their forces and friction to `out`. Rows and
// candidates go to sleep. ContactWork: where things stand.
void evaluate_springs(const Model&, const State&, const ContactWork&, ContactRow&, ContactCandidate*,
                      ContactChunk& out);
void evaluate_edges(const Model&, const State&, const ContactWork&, ContactRow&, ContactCandidate*,
                    ContactChunk& out);

} // namespace cdem
