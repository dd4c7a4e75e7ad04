// Forces of a field of water (water/water_field.hpp) on bodies, deformable or rigid, whole or broken. What acts, each once:
//
//   on the part of each face below the free surface
//     -p n                           pressure: buoyancy, and Froude-Krylov where the field's pressure is that of the motion
//     rho/2 C_D (u . -n)+ u          drag, u the velocity of the water less that of the surface (Feng 2014 eqs 19-20 for
//                                    C_D = 1, which a convex body has on its silhouette). Inside bodies it acts where
//                                    faces have parted (opened_faces.hpp)
//   on the volume below it
//     rho C_A Du/Dt                  added mass C_A = C_M - 1; what it takes from the body's own acceleration is inertia of
//                                    the nodes (ResolvedConditions::water_mass)
//     rho (Du/Dt + g grad(eta))      Froude-Krylov, only where the field's pressure is not that of the motion. The hydrostatic
//                                    pressure below a surface of slope grad(eta) holds the second term with the opposite sign
//
// The inertia terms act where all faces of a body take part: a part of its surface has no volume.
//
// The field is asked at the nodes now and then (ask_water): every 20 steps, and before a wave or the body itself has gone far
// (ResolvedFlow::longest). Between them all is linear. In every step the forces are those on the faces where they stand
// (place_water), with the pressure and the surface continued by their gradients from where the node was asked, and the volume
// is that under this surface. Forces that stayed with the nodes of a body that moves would do work in a cycle: still water would
// drive it.
//
// The free surface cuts triangles by a line, and the pressure vanishes there, so in still water the buoyancy is that of the
// cut mesh to rounding. It cuts tetrahedra by a plane likewise. The faces of convex blocks are triangles too, but for those that
// other blocks cover in part. Cavities that a body closes are part of the volume that it displaces.
// Weight is gravity's, in air as under water.
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

// Asks the field at the nodes of the flow's blocks where they stand, and finds which faces cracks have opened there.
void ask_water(const Model&, const State&, ResolvedFlow&);

// A field was asked too long ago.
bool water_is_old(const ResolvedConditions&, double time);

// Corners and forces of the flows of fields for where the faces stand now, and the water that moves with the nodes. nodes: those
// that are wanted, beside those of rigid bodies; others of the same blocks may get any.
void place_water(const Model&, const State&, Range nodes, int threads, ResolvedConditions&);

} // namespace cdem
