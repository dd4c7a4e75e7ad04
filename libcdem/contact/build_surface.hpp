// From the meshes of a Model to what of them can touch.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Fills model.surface for the laws in model.surface.joint. It stays empty when no two meshed blocks are there and no
// body may touch itself.
void build_surface(Model&);

// Stiffness per area of a contact of two triangles, Pa/m: what the joint gives, or that of the two tets behind them in
// series; the shear stiffness is the normal one unless given (Feng 2014).
struct ContactStiffness {
  double normal = 0, shear = 0;
};
ContactStiffness contact_stiffness(const Joint&, const ContactTriangle& a, const ContactTriangle& b);

// The law between two blocks; null: none is given.
const Joint* contact_joint(const Model&, int block_a, int block_b);

} // namespace cdem
