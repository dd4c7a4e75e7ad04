// What refine (cutting blocks near failure along their failure plane) takes and gives back.
#pragma once

#include "libcdem/model/selection.hpp"

#include <optional>

namespace cdem {

enum class Criterion { mohr_coulomb, griffith };
enum class CutMode { tension, shear };
enum class MayBreak { all, cut_faces, near_cuts };

struct Ball {
  geom::Vec3 centre = geom::Vec3::Zero(); // m
  double radius = 0;                      // m
};

// Han 2010 eqs 13-17 as amended in docs/theory.md.
struct RefineOptions {
  double tension_threshold =
      0; // delta_t, Pa, >= 0: cut when sigma3 + sigma_t <= delta_t (compression positive)
  double shear_threshold = 0; // delta_tau, Pa, >= 0: cut when the Mohr-Coulomb excess >= -delta_tau
  int planes = 3;             // equally spaced parallel cuts, 1..15: planes + 1 sub-blocks
  int max_depth = 1;          // a block of this generation is not cut again; 1..6
  Criterion criterion = Criterion::mohr_coulomb;
  std::optional<Selection> region; // blocks whose centroid lies in it
  std::optional<Ball> near;        // and those that reach into this
  // Every block by the mean stress here (fracture/tip_field.hpp), not by its own.
  std::optional<Ball> judged_by;
  // m; a crack's tip. In a block that touches it the planes are shifted so that one runs through it, and
  // turned a little where that one would pass close by a vertex: the cuts of neighbours line up. A block that
  // the plane through it does not enter stays whole.
  std::optional<geom::Vec3> anchor;
  std::optional<geom::Vec3> ahead; // way the crack has come; with an anchor: blocks behind it stay whole
  // Strength used by the criterion; by default that of the joint inside the block's body.
  std::optional<double> cohesion, friction_angle, tensile_strength; // Pa, rad, Pa
  // Which interfaces may break from now on: all, only the cut planes, or the cut planes and the original
  // faces between two cut blocks (docs/theory.md).
  MayBreak may_break = MayBreak::near_cuts;
};

struct BlockCut {
  std::int64_t block; // id of the block that was cut
  CutMode mode;
  geom::Vec3 centroid;    // m
  geom::Vec3 normal;      // unit, of the cut planes
  geom::Vec3 principal;   // Pa, compression positive, sigma1 >= sigma2 >= sigma3
  double angle_to_sigma1; // rad, between the plane and the sigma1 axis
  int generation;         // of the block that was cut, 0 for an original one
  int pieces;             // sub-blocks made
  bool tie;               // the two conjugate planes were equally good (see fracture/failure_plane.hpp)
};

} // namespace cdem
