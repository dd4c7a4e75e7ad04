// Law of two tetrahedra of one body that press on each other: from the joint of the body with itself.
#pragma once

#include "libcdem/contact/pairs/pair_contacts.hpp"

namespace cdem {

// The tetrahedra of this block meet as pairs: a deformable mesh with broken faces that has a law with itself.
bool pairs_within(const Model&, const ContactWork&, int block);

struct TetSize {
  double height = 0, area = 0; // m, m2: mean of its four faces, and its volume over it
  double compliance = 0;       // m/Pa
  double mass = 0;             // kg
};
TetSize size_of(const Model&, int tet);

// m. Tetrahedra that are still in place around a node touch only so deep, as semi-springs stand in from their corners: rock is
// pressed together by less before it breaks, so the edges of a crack keep clear of each other while its faces hold them.
double first_offset(const PairContacts&, std::int32_t row);

// Computes some pairs (which: of those found), and lets them take over the forces of faces.
void press_pairs(const Model&, const ContactWork&, const std::vector<std::int32_t>& rows,
                 const std::vector<std::int32_t>& which, int threads, std::vector<FoundPair>& found);

// What one contact does at these displacements, m, behind by a time `lag` (s) at the velocities of now.
FoundPair pressure_of(const Model&, const State&, const TetContact&, double lag = 0);

} // namespace cdem
