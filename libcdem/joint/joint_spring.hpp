// Interface of the laws of joints: the data of a spring that a law receives, and the history that it stores. A law is a
// struct of numbers with the functions below; joint/joint_law.hpp lists the laws and applies them. Pressures are
// positive in compression.
//
//   double pressure(spring, closure)        Pa, of faces pressed together by `closure` (m, > 0)
//   double closure(spring, pressure)        m, the inverse
//   double stored(spring, closure)          J/m2, the integral of the pressure
//   double pull(spring, opening, parted)    Pa, that holds faces `opening` apart (m, > 0); parted: the largest opening so far
//   double stored_pull(spring, opening, parted)   J/m2
//   double strength(spring, pressure, path) Pa, the shear it bears; pressure < 0: pulled
//   double rise(spring, pressure, path, slip_before, slip_after)   m, by which slip that grows makes the faces ride up
//   double friction_left(spring)            tan(phi) of the contact that is left once the blocks have parted
//   void   validate()                       throws geom::InputError
//   void   validate(spring)                 the same once the stiffness of the spring is known
//   void   each_member(visit)               every number, for files
#pragma once

#include "libgeom/core/error.hpp"
#include "libgeom/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace cdem {

struct JointSpring {
  double kn = 0, ks = 0;   // Pa/m, linear stiffness of the interface: the largest a law may have
  double tan_friction = 0; // of the joint's peak friction angle
};

// A spring whose joint has a law remembers this.
struct JointHistory {
  geom::Vec3 slip = geom::Vec3::Zero(); // m, of side b past side a since the faces fitted together
  double path = 0;                      // m, length of all slip under load
  double dilation = 0;                  // m, by which the faces have ridden up
  double parted = 0;                    // m, largest opening while something pulled the faces together
};

// A law without anything of its own: linear closure, no pull, no dilation.
struct LinearClosure {
  static double pressure(const JointSpring& spring, double closure) { return spring.kn * closure; }
  static double closure(const JointSpring& spring, double pressure) { return pressure / spring.kn; }
  static double stored(const JointSpring& spring, double closure) {
    return 0.5 * spring.kn * closure * closure;
  }
};
struct NoPull {
  static double pull(const JointSpring&, double, double) { return 0; }
  static double stored_pull(const JointSpring&, double, double) { return 0; }
};
struct NoDilation {
  static double rise(const JointSpring&, double, double, double, double) { return 0; }
};

inline void require_of_joint(bool ok, const char* field, double value, const std::string& allowed,
                             const char* advice = "") {
  if (ok)
    return;
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  throw geom::InputError(field, text, allowed, advice);
}

} // namespace cdem
