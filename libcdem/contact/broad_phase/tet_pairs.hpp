// Which pairs of single tetrahedra there are: those that a search has found stay until one of the two is searched again.
#pragma once

#include "libcdem/contact/broad_phase/near_triangles.hpp"
#include "libcdem/contact/data/tet_pairs.hpp"

namespace cdem {

// Not of cohesive bodies, which gain nothing by pairs: their fragments keep their rows.
inline bool is_single_tet(const Model& model, const ContactWork& work, int mover) {
  const Block& block = model.blocks[work.movers.block[mover]];
  return !model.bodies[block.body].bonding.is_cohesive() && work.movers.triangles_of_tet[mover][0] >= 0;
}

// Movers have new numbers. now_of: per mover by the number before; -1: it has changed, or is no more.
void renumber_tet_pairs(const std::vector<int>& now_of, ContactWork&);

// Writes ContactWork::tet_pairs: those of which neither mover was searched, and those found, which are left out of `pairs`.
// pairs: of movers, sorted.
void keep_tet_pairs(const Model&, const std::vector<char>& searched, Pairs& pairs, ContactWork&);

// None of them is skipped in the next step.
void let_tet_pairs_wake(ContactWork&);

// Whether this rank computes the semi-springs of a triangle on single tetrahedra (data/row_owner.hpp).
inline bool keeps_tet_triangle(const std::array<int, 2>& own_triangles, int triangle) {
  return triangle >= own_triangles[0] && triangle < own_triangles[1];
}
std::array<int, 2> own_triangles(const ContactWork&);

} // namespace cdem
