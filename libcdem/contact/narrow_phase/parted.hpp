// Two rigid convex blocks of which the plane of a face has all nodes of the other on its outer side.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// m, how far such a plane parts them, at least: until they have moved so far no semi-spring of one stands in the other. 0: no
// plane was found. Of a pair whose motion is up to date; writes RigidPair::planes and others_until.
double parted_by(const Model&, const State&, const ContactWork&, RigidPair&);

} // namespace cdem
