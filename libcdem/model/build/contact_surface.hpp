// Builds the contact surface from the meshes of a Model.
#pragma once

#include "libcdem/model/model.hpp"

#include <optional>

namespace cdem {

// Fills model.surface for the laws in model.surface.joint. It stays empty when no two meshed blocks are there and no
// body may touch itself. before: the surface of the same bodies with other nodes freed; its edges are the same.
void build_surface(Model&, const ContactSurface* before = nullptr);

// Edges of less than this turn are flat: what touches there touches the triangles.
inline constexpr double least_edge_turn = 0.05; // radians

// The edge that two triangles share, of each from its corner to the next.
ContactEdge edge_between(const ContactSurface&, int triangle_a, int corner_a, int triangle_b, int corner_b);
// The same where the surface turns outwards there, undeformed.
std::optional<ContactEdge> convex_edge(const Model&, int triangle_a, int corner_a, int triangle_b,
                                       int corner_b);

// Stiffness per area of a contact, Pa/m: what the joint gives, or that of the two tets in series, whose compliances (m/Pa)
// add up to this; the shear stiffness is the normal one unless given (Feng 2014).
struct ContactStiffness {
  double normal = 0, shear = 0;
};
ContactStiffness contact_stiffness(const Joint&, double compliance);

// The law between two blocks, or between what one has broken into; null: none is given.
const Joint* contact_joint(const Model&, int block_a, int block_b);

// The law of a contact by its triangles: one, twice, of a semi-spring and of its target, both of a semi-edge. Blocks of one body
// that no interface held keep the friction of the joints at the faces that meet; of several the least counts.
using TrianglesOfSide = std::array<int, 2>;
int law_left_between(const Model&, const TrianglesOfSide&,
                     const TrianglesOfSide&); // of those joints; -1: there is none
const Joint* contact_joint(const Model&, const TrianglesOfSide&, const TrianglesOfSide&);

// tan of the friction angle between two tetrahedra of one mesh whose law this is: where a joint of its own was between their
// regions, the friction that is left of it.
double friction_within(const Model&, const Joint&, int tet_a, int tet_b);

} // namespace cdem
