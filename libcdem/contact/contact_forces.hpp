// Forces of semi-springs and semi-edges (Feng 2014 section 2.2), found by the nearest place of the target's surface.
//
// A semi-spring lies inside a fragment when the triangles that hold the nearest place of its surface have it behind
// (contact/nearest.hpp). Its depth d is the distance to that place and its normal points there: the force
// is the gradient of kn d^2 / 2, and as it acts along the line of its two places it keeps the angular momentum. The
// paper's face-by-face test finds the same wherever the nearest place lies within a face, and leaves gaps where two
// faces meet in a re-entrant edge.
//
// A semi-edge acts on an edge of another fragment where their common normal lies in the fans of outward normals of both
// (Gauss map), and their nearest places within both. Near-parallel edges (sin < 0.01) are left to the semi-springs.
// Both act side by side: switching the edges off where a spring of the same faces acts, as the paper does, throws
// away what they store, and gives it back when the spring lets go.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Advances State::contacts and writes the workspace for where the nodes are; searches when something has moved.
// Nothing happens when nothing moved since the last call.
ContactSums contact_forces(const Model&, State&, ContactWork&, int threads);

// J, that contacts store `lag` seconds before now, at the velocities of now.
double contact_energy(const Model&, const State&, double lag);

} // namespace cdem
