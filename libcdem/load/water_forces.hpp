// Forces of a field of water (water/water_field.hpp) on bodies, deformable or rigid, whole or broken. What acts, each once:
//
//   on the part of each face below the free surface
//     -p n                           pressure: buoyancy, and Froude-Krylov where the field's pressure is that of the motion
//     rho/2 C_D (u . -n)+ u          drag, u the velocity of the water less that of the surface (Feng 2014 eqs 19-20 for
//                                    C_D = 1, which a convex body has on its silhouette)
//   on the volume below it
//     rho C_A Du/Dt                  added mass C_A = C_M - 1; what it takes from the body's own acceleration is inertia of
//                                    the nodes (ResolvedConditions::water_mass)
//     rho Du/Dt                      Froude-Krylov, only where the field's pressure is not that of the motion
//
// The field is asked at the nodes; between them all is linear. The free surface cuts triangles by a line, and the pressure
// vanishes there, so in still water the buoyancy is that of the cut mesh to rounding. Faces of convex blocks of small strain
// are cut at nodes only. Weight is gravity's, in air as under water.
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

struct WaterForces {
  std::vector<FlowCorner> corners; // for the drag, which depends on the velocity of the surface
  std::vector<std::pair<int, geom::Vec3>> steady; // node, N: all but the drag
};

// water_mass: grows to n_nodes where there is added mass.
WaterForces water_forces(const Model&, const State&, const ResolvedFlow&, std::vector<double>& water_mass);

} // namespace cdem
