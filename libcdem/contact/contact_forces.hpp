// Forces of semi-springs and semi-edges (Feng 2014 section 2.2), found by the nearest point of the target's surface.
//
// A semi-spring lies inside a fragment when it is behind the triangles that contain the nearest point of the fragment's
// surface (contact/geometry/nearest.hpp). Its depth d is the distance to that point, and its normal points there. The
// force is the gradient of kn d^2 / 2. It acts along the line between the two points, so it conserves the angular
// momentum. The paper's face-by-face test gives the same result if the nearest point lies within a face. Where two
// faces meet in a re-entrant edge it finds no face.
//
// A semi-edge acts on an edge of another fragment where their common normal lies in the fans of outward normals of both
// (Gauss map), and their nearest places within both. Near-parallel edges (sin < 0.01) are left to the semi-springs.
// Both act at the same time. The paper switches the edges off where a spring of the same faces acts. This would remove
// their stored energy, and return it when the contact of the spring ends.
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
