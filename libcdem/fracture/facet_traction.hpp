// The traction on the facets of joined blocks without zones (bonds = "cohesive"), in balance with their blocks. The stress of
// the two tets at a face of a star mesh does not see bending: by symmetry they have no normal strain there, and the moment
// passes through the tets beside them. The nodal forces of all tets of a block see it.
//
//   g_P(R) = - sum over the tets of block R at P of sigma S / 3     S: area vector of the face opposite to P, outward
//
// is the force that the surroundings give to the block at node P. Each facet F at P takes a part t_P(F) of it, its other
// block the opposite, and outer faces take what all blocks at P miss together (load, support, weight, inertia). The parts are
// those nearest to the mean stress of both tets, for the areas a_P(F) = integral of the shape function of P over F:
//
//   t_P(F) = a_P sigma_mean n + d_P(F),   sum of |d_P|^2 / a_P least   =>   d_P = a_P (lambda(R) - lambda(R')),
//
// with lambda from the graph Laplacian of the blocks at P. Between two blocks alone t_P is exact. The linear traction
//
//   t(x) = V / A + n m . r + w x r,   r = x - centroid,   V = sum t_P,   m = J^-1 sum r (t_P . n),   w = n M_n / tr J
//
// has the resultant and the moment of these forces, J = integral of r r over F. A uniform stress gives sigma n exactly.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/state/state.hpp"

#include <vector>

namespace cdem {

struct FacetTraction {
  int body = 0;
  geom::Vec3 centroid = geom::Vec3::Zero(), normal = geom::Vec3::Zero(); // m now; unit
  geom::Vec3 mean = geom::Vec3::Zero();                                  // Pa, pull positive along the normal
  geom::Mat3 gradient = geom::Mat3::Zero();                              // Pa/m
  double utilisation = 0; // 1 / the factor with which the traction reaches the strength, at the worst corner
  geom::Vec3 worst = geom::Vec3::Zero(); // m, that corner
  double area = 0;                       // m2
  double least_extent = 0;               // m, of both blocks, along an axis
  double block_stress = 0;               // Pa, norm of the mean stress of a block, the larger of both
  double unknown = 0; // Pa, what outer forces at its nodes that no stress tells the blocks of would give

  // The facet lies across a block, and the traction changes over it by more than the stress in so few tets errs.
  bool is_bent() const {
    return area > least_extent * least_extent / 4 && (at(worst) - mean).norm() > block_stress / 2 + unknown;
  }
  geom::Vec3 at(const geom::Vec3& x) const { return mean + gradient * (x - centroid); }
};

bool may_have_facets(const Model&); // by the bonding of its bodies alone

// All plane facets that lie at no crack, where the forces are those of its law too. Bodies with zones have none.
std::vector<FacetTraction> facet_tractions(const Model&, const State&);

} // namespace cdem
