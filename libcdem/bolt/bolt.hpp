// A grouted bolt or cable: a bar of steel in a straight hole, and what its user gives.
#pragma once

#include "libgeom/core/types.hpp"

#include <limits>

namespace cdem {

struct Bolt {
  geom::Vec3 from = geom::Vec3::Zero(); // m, undeformed; the collar
  geom::Vec3 to = geom::Vec3::Zero();
  int segments = 10;
  double area = 0;                                                 // m2, of the steel, > 0
  double youngs_modulus = 0;                                       // Pa, of the steel, > 0
  double yield_force = std::numeric_limits<double>::infinity();    // N, > 0
  double grout_stiffness = 0;                                      // N/m per m of bolt, > 0
  double grout_strength = std::numeric_limits<double>::infinity(); // N per m of bolt, > 0
  double pretension = 0;                                           // N, in the plate once the bolt is tight
  double free_length = 0;                                          // m from the collar on, without grout
  bool plate = false;                                              // the collar is fast to the rock

  double length() const { return (to - from).norm(); }
};

// Throws geom::InputError naming the field, its value and the allowed range.
void validate(const Bolt&);

// A node of a bolt remembers this. Displacements are axial, from `from` to `to`.
struct BoltNode {
  double origin = 0;  // m, displacement of the rock here when the bolt was set
  double rock = 0;    // m, displacement of the rock since, when the forces were last found
  double slip = 0;    // m, of the bolt's sleeve past the grout's strength, rock before steel
  double stretch = 0; // m, of the segment to the next node that does not go back: yield and pretension
  double grout = 0;   // N, on the steel, towards `to`
  double tension = 0; // N, in the segment to the next node
};

} // namespace cdem
