// What contacts add to the bounds of the largest eigenvalue of stiffness over mass (Gershgorin), for the stable step.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// s: bound of the stable step of all nodes and rigid bodies that contacts act on, as they are now; row_sums: those of
// elements and bonds, N/m (n_nodes). Infinite without contacts.
double contact_time_step(const Model&, const State&, const Workspace&, const std::vector<double>& row_sums);

// The same before anything touches, for rigid bodies, if a fiftieth of their surface does: a step that lets no more than
// a few contacts close at once. contact_time_step shortens it when more do.
double rigid_frequency2(const Model&);

// Adds to the row sums what contacts may at most add at the surface, when all of it is pressed by its like, N/m.
void add_contact_row_sums(const Model&, std::vector<double>& row_sums);

} // namespace cdem
