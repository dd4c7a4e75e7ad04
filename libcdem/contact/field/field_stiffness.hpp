// Stiffness of the field of block A for what block B presses into it, Pa/m. Two flat faces pressed by a small depth d carry
// the pressure
//   p = (K_A |grad phi_A| + K_B |grad phi_B|) d = kn' d,   kn' = 1 / (h_A / E_A + h_B / E_B) or Joint::normal_stiffness,
// as each field brings half of it: K_A = kn' / (2 |grad phi_A|), with the h of its own cell and of B the usual one.
#pragma once

#include "libcdem/model/build/contact_surface.hpp"

namespace cdem::field {

// K of a cell of one block, and of all its sharp edges (which take the usual h on both sides).
inline double cell_stiffness(const Model& model, const Joint& joint, const FieldCell& cell, int other) {
  return contact_stiffness(joint, cell.compliance + model.field.compliance[other]).normal / (2 * cell.slope);
}
inline double edge_stiffness(const Model& model, const Joint& joint, int source, int target) {
  return contact_stiffness(joint, model.field.compliance[source] + model.field.compliance[target]).normal / 2;
}
// ks / kn.
inline double shear_ratio(const Model& model, const Joint& joint, int source, int target) {
  const ContactStiffness k =
      contact_stiffness(joint, model.field.compliance[source] + model.field.compliance[target]);
  return k.shear / k.normal;
}

} // namespace cdem::field
