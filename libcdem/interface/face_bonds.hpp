// Bonds between the two sides of inner faces of a mesh (Feng 2014 section 2.3, law eq 18). Three springs a face, at
// points drawn in from its corners (weights 2/3, 1/6, 1/6: at the corners a broken piece would stay hinged), with
//   Kn = beta E A / (3 d),  Ks = ratio Kn,  d = 3 (V1 + V2) / 4A the distance of the two centroids,
// and the gap g from a to b of the two sides in space, so that the law follows any motion:
//   bonded:  F = Ks g + (Kn - Ks) (g . n) n,  breaks when  Fn > T A/3  (tension) or  Fs > C A/3 - Fn tan(phi)
//   broken:  the contact it would always have been: no tension, Fs <= -Fn tan(phi), slip turns with the face
// n: mean of the two sides' area vectors, made a unit vector. With Ks = Kn the force lies along the gap and keeps the
// angular momentum.
#pragma once

#include "libcdem/model/mesh.hpp"
#include "libcdem/results/snapshot.hpp"

#include <vector>

namespace cdem {

struct FaceLaw {
  double shear_ratio = 1;      // Ks / Kn
  double tensile_strength = 0; // T, Pa
  double cohesion = 0;         // C, Pa
  double tan_friction = 0;
};

// Of the three springs of eight faces; a spring's place in the whole is (batch * 3 + point) * lanes + lane.
struct FaceStateBatch {
  double slip[3][3][lanes];    // m, tangential gap at which a broken spring carries no shear: point, axis
  std::uint8_t mode[3][lanes]; // BondMode
};

// Its sides have parted since it broke: what meets there is found by search (contact/).
inline bool handed_over(const FaceStateBatch&, int) {
  return false;
}

struct FaceBreak {
  std::int64_t spring = 0; // place as above, of the range's first batch on
  BondMode mode = BondMode::intact;
  geom::Vec3 normal = geom::Vec3::Zero();
  double normal_traction = 0, shear_traction = 0; // Pa, at breaking
};

struct FaceSums {
  double friction = 0; // J, this step
  double breaking = 0; // J, this step
  std::vector<FaceBreak> broken;
};

// Adds the forces of `faces` faces in `count` batches to `force`; breaking: springs may break. position, displacement
// (m), force: one entry for each place of the chunk.
void face_bond_forces(const FaceBatch*, std::int64_t count, int faces, const Node* position,
                      const Node* displacement, const FaceLaw&, bool breaking, FaceStateBatch*, Node* force,
                      FaceSums&);

// Of one spring; position, displacement: m (n_nodes).
struct FaceSpring {
  geom::Vec3 gap = geom::Vec3::Zero();    // m, from a to b
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, from a to b
  geom::Vec3 force = geom::Vec3::Zero();  // N, on side a
  double energy = 0;                      // J
};
FaceSpring face_spring(const FaceBatch&, int point, int lane, const Node* position, const Node* displacement,
                       const FaceLaw&, const FaceStateBatch&);

} // namespace cdem
