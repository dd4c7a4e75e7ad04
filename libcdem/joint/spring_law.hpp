// Law of one spring between two faces, per area (Han 2010 eqs 8-11 as amended in docs/theory.md).
//
//   bonded:   t = kn (j - o).n n + ks (j - o)_s,   j jump of the displacement from a to b, o that at t = 0
//
// broken or never bonded:
//   closed (t_n <= 0):  the same, |t_s| limited to |t_n| tan(phi), o_s slips with it
//   open (t_n > 0):     t = 0, o_s follows j_s so that a closing face starts without shear
//
// A bond that softens on the way from one to the other: joint/softening.hpp.
#pragma once

#include "libcdem/joint/coulomb_friction.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"
#include "libgeom/core/types.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

struct SpringResponse {
  geom::Vec3 traction = geom::Vec3::Zero(); // Pa, pulls a towards b when along the normal
  geom::Vec3 offset = geom::Vec3::Zero();   // m, new o
};

inline SpringResponse contact_response(double kn, double ks, double tan_friction, const geom::Vec3& normal,
                                       const geom::Vec3& jump, const geom::Vec3& offset) {
  SpringResponse r;
  const geom::Vec3 stretch = jump - offset;
  const double open = stretch.dot(normal);
  const geom::Vec3 shear = stretch - open * normal;
  if (open > 0) {
    r.offset = offset + shear;
    return r;
  }
  const double normal_traction = kn * open;
  const double limit = friction_limit(-normal_traction, tan_friction);
  const double shear_traction = ks * shear.norm();
  r.offset = offset;
  r.traction = normal_traction * normal + ks * shear;
  if (shear_traction > limit) {
    const double scale = held_by_friction(shear_traction, limit);
    const geom::Vec3 slip = (1 - scale) * shear;
    r.offset += slip;
    r.traction = normal_traction * normal + (ks * scale) * shear;
  }
  return r;
}

// J/m2, that a spring of these stiffnesses stores under a traction.
inline double stored_in_spring(double kn, double ks, const geom::Vec3& normal, const geom::Vec3& traction) {
  const double tn = traction.dot(normal);
  return 0.5 * (tn * tn / kn + (traction.squaredNorm() - tn * tn) / ks);
}

// Energy a spring lost over a step in which its traction went from t0 to t1 while its stretch would have become
// `trial` with the offset held: work of the motion by the trapezoidal rule (which is what central differences do) less
// the change of what is stored, J/m2. k: the stiffness in the direction of these vectors.
inline double lost_energy(double k, const geom::Vec3& t0, const geom::Vec3& t1, const geom::Vec3& trial) {
  return 0.5 * (t0 + t1).dot(trial - t0 / k) - 0.5 * (t1.squaredNorm() - t0.squaredNorm()) / k;
}

} // namespace cdem
