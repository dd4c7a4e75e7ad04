// Contacts of a block with itself, by pairs of its tetrahedra (response/tet_potential.hpp, response/tet_push.hpp).
//
// A pair that is found in an overlap starts without a force: phi0 is that overlap. It falls to the overlap there is, and one that
// has parted is forgotten, in the steps in which overlaps are forgotten (forgets_overlaps), whether the pair is asleep or not. A pair
// that came together within the step starts at 0.
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
