// Which surface triangles and sharp edges are near which cells of the field: boxes that hold all that may touch before a
// block has left its skin. Candidates carry no history.
#pragma once

#include "libcdem/contact/taking_part.hpp"

namespace cdem::field {

struct NearCell {
  Contact::Kind kind = Contact::spring;
  int source = 0; // triangle; edge of ContactSurface
  int block = 0;  // of the cell
  int cell = 0;
};

// Of two blocks, each as source of the other.
std::vector<NearCell> near_cells(const Model&, const State&, const ContactWork&, const TakingPart&,
                                 int block_a, int block_b);

// Writes ContactWork::field_rows, field_candidates and field_near.
void make_field_rows(const Model&, const std::vector<std::vector<NearCell>>&, ContactWork&);

} // namespace cdem::field
