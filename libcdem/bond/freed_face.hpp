// One freed face of a cohesive body: how its sides hold together, and the cohesive law once it cracks.
//
// A face that holds has the traction of element/face_jumps.hpp; its penalty k (j + o) is computed here, with j the
// relative displacement at three points of the face, and o = 0 unless a crack began there and did not continue. When
// the stress s that it bears reaches the strength on a plane with the normal m (fracture/begin_cracks.hpp) the
// face cracks. From then on its law acts on that plane, for any direction n of the face, and does not depend on the
// stress of the tets:
//   t = (m.n) law(j) + (1 - D) r0
// law: bond/cohesive_law.hpp on the plane m, D its damage; brittle: the contact that is left. It begins with the traction s m,
// brought back to the strength where it is beyond it. r0 is the traction of the face less (m.n) s m, so that the traction is
// continuous. A crack takes G times its area projected on m, for any faces that it follows. On the faces' own planes a crack
// that zigzags would lock.
//
// What becomes of such a face, by its stage (state/face_state.hpp); D is the damage of its points:
//
//   from         to          when                                                        by
//   holding,     cracking    what it bears reaches the strength                          begin_crack, D = 0 or what was left
//   resumed
//   cracking     resumed     it unloads before it is damaged by a tenth                  end_crack
//   cracking     cracking    a brittle one, a step after it began                        let_go, D = 1
//   these three  cracking    it is broken by hand, or by an initial stress               break_face, D = 1
//   cracking     separated   D = 1 at all points, and none carries anything: what is     bond/end_of_face.hpp
//                            left is a contact on the face's own plane
//   cracking,    parted      D = 1, and its sides have opened or slid away from each     the same; bond/leaving_faces.hpp
//   separated                other: the contact of the surface takes over
//   parted       separated   its sides stand open where they met                         bond/leaving_faces.hpp
#pragma once

#include "libcdem/bond/face_frame.hpp"
#include "libcdem/bond/face_joints.hpp"
#include "libcdem/joint/softening.hpp"
#include "libcdem/state/cohesive_face.hpp"

#include <algorithm>
#include <optional>

namespace cdem {

// Stiffness of the law of a cracked face over the penalty of a face that holds. The stable step stands it: the mean stress of
// the tets, which acts on a face that holds, is gone.
constexpr double crack_stiffness = 1.8;
// A crack ends where no more than this part of the strength that is left is asked of its face.
constexpr double unloaded_part = 0.97;

// The law of a cracked face of a body with this joint, whose penalty is k, Pa/m.
SofteningLaw cohesive_law(const Joint&, double k);

// As face_spring; the face stands as `f`.
FaceSpring cohesive_spring(const FaceBatch&, int lane, const FaceFrame& f, int point, const Joint&,
                           const FaceStateBatch&, const CohesiveFace&);

// A face with its law and all that it remembers.
struct FreedFace {
  const FaceBatch& batch;
  int lane;
  const Joint& joint;
  FaceStateBatch& state;
  CohesiveFace& face;

  FaceSpring spring(const FaceFrame& f, int point) const {
    return cohesive_spring(batch, lane, f, point, joint, state, face);
  }
  double stored(const FaceFrame&) const;                               // J
  double penalty() const { return batch.kn[lane] / batch.area[lane]; } // k, Pa/m
};

// A face at the moment of its stress, and what its sides have done since.
struct FaceMoment {
  FaceFrame frame;
  std::array<geom::Vec3, 3> moved{geom::Vec3::Zero(), geom::Vec3::Zero(),
                                  geom::Vec3::Zero()}; // m, in space, change of `gap` since then
  geom::Mat3 stress = geom::Mat3::Zero();              // Pa, in space, mean of the two tets
  geom::Mat3 borne = geom::Mat3::Zero();               // Pa, in space, s above
  geom::Mat3 relieved = geom::Mat3::Zero(); // Pa, change of the stress where a crack begins at the strength
  // Pa, in space, what each point carries where the face is judged by that: between joined blocks without zones.
  std::optional<std::array<geom::Vec3, 3>> carried = {};
};

// Pa, in space, on side a: what the three points carry of a face that holds (stress . normal + k (j + o)) or cracks.
std::array<geom::Vec3, 3> carried_tractions(const FreedFace&, const FaceFrame&, const geom::Mat3& stress);
// Pa, in space, mean of the points: of a face that cracks, or what the penalty of one that holds adds to that of its stress.
geom::Vec3 mean_traction(const FreedFace&, const FaceFrame&);

// Begins a crack on the plane with the unit normal m; a brittle face is broken, in this mode, and lets go in the next step.
// Returns the energy that the face no longer stores, J (negative where it stores more), with the half step's work that its
// traction has done since then and no store has got.
double begin_crack(const FreedFace&, const FaceMoment&, const geom::Vec3& m, BondMode);

// A brittle face that has begun to crack carries nothing but contact from now on. The same returned.
double let_go(const FreedFace&, const FaceMoment&);

// Goes back to holding where a face that may end has unloaded. The same returned.
std::optional<double> end_crack(const FreedFace&, const FaceMoment&);

// Makes the face a crack without strength along its own plane. It keeps what pressure and friction hold of the traction that
// its sides have now: that of its springs and, Pa, in space, that of `stress` on the face.
void break_face(const Model&, State&, const MeshChunk&, std::int64_t batch, int lane,
                const geom::Mat3& stress);

// Largest damage of its points.
inline double damage_of(const CohesiveFace& face) {
  return std::max({face.damage[0], face.damage[1], face.damage[2]});
}

// Hardly damaged yet: it goes back to holding once it has unloaded; a brittle one lets go.
inline bool may_end(const CohesiveFace& face) {
  constexpr double hardly_damaged = 0.1;
  return damage_of(face) <= hardly_damaged;
}

} // namespace cdem
