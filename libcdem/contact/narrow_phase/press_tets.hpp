// Contacts of a block with itself, by pairs of its tetrahedra (response/tet_potential.hpp).
//
// A pair that is found in an overlap starts without a force: phi0 is that overlap. It falls to the overlap there is every
// 20 steps of the model (relaxes), whether the pair is asleep or not. A pair that came together within the step starts at 0.
//
// The normal force N of a contact is the resultant of the gradient, its normal n the direction of it. Corner i of a
// tetrahedron with the force f_i has the weight f_i . n / N: friction and damping act by these weights, so they
// keep momentum.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/data/tet_contacts.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// What one chunk of pairs found in a step.
struct TetChunk {
  std::vector<Contact> contacts;
  std::vector<TetPairForce> forces;        // of those that press
  std::vector<double> friction, damping;   // J, of each pair: which pairs a chunk has hangs on what sleeps
  double depth = 0, depth_over_height = 0; // largest, m and in parts of the lower tetrahedron's height
  std::array<int, 2> deepest{-1, -1};      // tetrahedra
};

// Finds the contacts of all pairs, in the order of keys. Pairs go to sleep.
std::vector<TetChunk> press_tets(const Model&, const State&, ContactWork&, int threads);

} // namespace cdem
