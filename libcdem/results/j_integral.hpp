// Energy release rate at a straight crack front or notch: the domain form of the J integral (Li, Shih and Needleman 1985,
// Eng. Fract. Mech. 21), averaged over the thickness.
//
//   J = 1/B sum over tets V (sigma_ij u_i,1 - W delta_1j) q_,j        W = sigma : C^-1 : sigma / 2
//
// Axis 1 is the direction of growth. q depends on the distance r from the front alone: 1 up to the inner radius, falling
// linearly to 0 at the outer one, interpolated between the nodes; B is the length of the front in the body. Tets inside
// the inner radius take no part, so a notch may be blunt there.
//
// Valid for a body of one material at rest at small strains and rotations, with free crack faces parallel to the
// growth, in a domain without supports (except across the thickness), loads, contacts or bonds that carry a force.
// Other cases are refused.
#pragma once

#include "libgeom/core/types.hpp"

#include <vector>

namespace cdem {

struct Model;
struct State;
struct ResolvedConditions;

struct JFront {
  int body = 0;                           // its number
  geom::Vec3 point = geom::Vec3::Zero();  // m, undeformed, anywhere on the front
  geom::Vec3 front = geom::Vec3::Zero();  // its direction, unit
  geom::Vec3 growth = geom::Vec3::Zero(); // unit, square to it
};

struct JDomain {
  double inner = 0, outer = 0; // m
  double j = 0;                // J/m2
};

struct JIntegral {
  double thickness = 0;         // B, m
  std::vector<JDomain> domains; // as asked for
  double mean() const;          // J/m2
  double spread() const;        // largest less smallest, over |mean|; 0 of one domain
};

// domains: inner and outer radii. Throws geom::InputError where the integral would not be the energy release rate.
JIntegral j_integral(const Model&, const State&, const ResolvedConditions&, const JFront&,
                     std::vector<JDomain> domains);

} // namespace cdem
