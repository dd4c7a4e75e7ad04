// Interfaces as faces that break as a whole: the ratio of traction to strength of each face, and the breaking of a
// face.
//
// The traction of a face is the mean over its intact springs. A spring at a crack's tip carries a stress that
// grows without bound as blocks get smaller; the mean over a face of a given size does not, and ranks faces
// by it.
#pragma once

#include "libcdem/joint/spring_law.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// How many times over its strength a traction is: one over the factor that would scale it to the limit. The
// larger of tension, t_n / sigma_t, and Mohr-Coulomb, (|t_s| + t_n tan(phi)) / c0 (Han 2010 eqs 10-11, signed
// t_n); 1 at breaking, infinite where there is no strength. mode: which of the two it is.
struct LoadRatio {
  double value = 0;
  BondMode mode = BondMode::broken_tension;
};
LoadRatio load_ratio(const SpringStrength&, double normal_traction,
                     double shear_traction); // Pa, tension positive

struct FaceLoad {
  int interface = 0; // index into Model::interfaces
  LoadRatio ratio;
  double normal_traction = 0, shear_traction = 0; // Pa, mean over the intact springs
};

// Every interface that may break and has an intact spring, in the model's order.
std::vector<FaceLoad> face_loads(const Model&, const State&);

// The faces that are at their strength (ratio >= 1) and carry at least `break_ratio` of the worst one's
// ratio.
std::vector<FaceLoad> worst_faces(const std::vector<FaceLoad>&, double break_ratio);

// A broken face of the crack, as it lay in the undeformed body.
struct CrackFace {
  std::int64_t interface = 0; // id
  int pass = 0, round = 0;    // when it broke; rounds count within a pass
  BondMode mode = BondMode::broken_tension;
  geom::Vec3 centroid = geom::Vec3::Zero(); // m, of the part that broke
  geom::Vec3 normal = geom::Vec3::UnitX();
  double area = 0;  // m2
  double ratio = 0; // traction over strength when it broke
};

// Breaks the intact springs of a face: they are contacts from now on. The stored energy they lose goes to the
// ledger's `breaking`, each spring to the log. pass and round stay 0.
CrackFace break_face(const Model&, State&, RunLog&, int stage, const FaceLoad&);

} // namespace cdem
