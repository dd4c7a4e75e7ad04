// Bonds between the two sides of inner faces of a mesh (Feng 2014 section 2.3, law eq 18). Three springs a face, at
// points drawn in from its corners (weights 2/3, 1/6, 1/6: at the corners a broken piece would stay hinged), with
//   Kn = beta E A / (3 d),  Ks = ratio Kn,  d = 3 (V1 + V2) / 4A the distance of the two centroids,
// and the relative displacement g from a to b of the two sides in space, so that the law follows any motion:
//   bonded:  F = Ks g + (Kn - Ks) (g . n) n,  breaks when  Fn > T A/3  (tension) or  Fs > C A/3 - Fn tan(phi)
//   broken:  the contact it would always have been: no tension, Fs <= -Fn tan(phi), slip turns with the face
// n: mean of the two sides' area vectors, made a unit vector. With Ks = Kn the force is parallel to g and conserves the
// angular momentum. Slip is kept along the face's own axes: its first edge, the mean of both sides, and across.
//
// The contact treats the two sides as infinite planes, which is valid while they lie opposite each other. A face that
// has broken and then parted or slid away is handed over to the contact of the surface where there is one for its body.
#pragma once

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/parallel/read_ahead.hpp"
#include "libcdem/state/crack_energy.hpp"
#include "libcdem/state/face_state.hpp"

#include <vector>

namespace cdem {

struct FaceLaw {
  double shear_ratio = 1;      // Ks / Kn
  double tensile_strength = 0; // T, Pa
  double cohesion = 0;         // C, Pa
  double tan_friction = 0;
  const FaceStrengthBatch* own = nullptr; // of the first batch, where faces have strengths of their own
  bool hands_over = false;    // broken faces that part or slide away go to the contact of the surface
  bool hand_over_due = false; // in this step
};
FaceLaw face_law(const Body&);
FaceLaw face_law(const Model&, const MeshChunk&, std::int64_t batch, int lane); // of one face
FaceLaw at_lane(const FaceLaw&, int lane); // of one face of the first batch

struct FaceBreak {
  std::int64_t spring = 0; // place as above, of the range's first batch on
  BondMode mode = BondMode::intact;
  geom::Vec3 normal = geom::Vec3::Zero();
  double normal_traction = 0, shear_traction = 0; // Pa, at breaking
  double slip[2] = {}, shear[2] = {};             // m, N, as in FaceSlip, right after
};

// What the pressure in a crack gives the corners of a face (load/crack_pressure.hpp).
struct CrackPush {
  FaceNodes nodes;
  geom::Vec3 push = geom::Vec3::Zero();   // N, on each corner of side b, the opposite on side a
  geom::Vec3 before = geom::Vec3::Zero(); // m/s, by which corners of b left those of a before the step, sum
};

struct FaceSums {
  double friction = 0;           // J, this step
  double breaking = 0;           // J, this step
  CrackEnergy crack;             // J, this step: what of `breaking` went into cracks
  double damping = 0;            // J, this step, of the tetrahedra of the same chunk
  double plastic = 0;            // J, likewise
  std::vector<CrackPush> pushes; // by the pressure in cracks, this step
  double applied2 = 0;           // N2, squares of these forces
  std::vector<FaceBreak> broken;
  // A face, batch * lanes + lane from the range's first batch on, that is closed and has slid further than it is long;
  // -1: none. Only where nothing takes it over.
  std::int64_t astray = -1;
  bool hands_over = false; // some face begins to leave, has left, or is taken back, in this step
};

// What the nodes of a chunk do, one entry for each of its places.
struct FaceMotion {
  const Node* position;     // m
  const Node* displacement; // m
  const Node* velocity;     // m/s, over the last `step` seconds
  double step;
};

// Adds the forces of `faces` faces in `count` batches to `force` (N, per place); breaking: springs may break. The slip
// of a face whose first spring breaks is only in FaceSums::broken: its owner makes room for it after the step.
void face_bond_forces(const FaceBatch*, std::int64_t count, int faces, const FaceMotion&, const FaceLaw&,
                      bool breaking, FaceStateBatch*, FaceSlipBatch*, Node* force, FaceSums&, ReadAhead&);

// State of one spring. position, displacement: m (n_nodes).
struct FaceSpring {
  geom::Vec3 gap = geom::Vec3::Zero();    // m, from a to b
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, from a to b
  geom::Vec3 force = geom::Vec3::Zero();  // N, on side a
  double energy = 0;                      // J
};
FaceSpring face_spring(const FaceBatch&, const FaceNodes&, int point, int lane, const Node* position,
                       const Node* displacement, const FaceLaw&, const FaceStateBatch&, const FaceSlip&);

// Lets a spring that has just become a contact slide to where friction holds it.
void settle(const FaceBatch&, const FaceNodes&, int point, int lane, const Node* position,
            const Node* displacement, const FaceLaw&, FaceSlip&);

} // namespace cdem
