// Freed faces of cohesive bodies: how their sides hold together, and the cohesive law once they crack.
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
// A face that unloads with little damage becomes whole again. A face whose points have lost all strength and are open has
// separated: what is left of its springs is a contact on the face's own plane, as a broken face of a body with springs has it
// (bond/broken_faces.hpp), until its sides have parted or slid away and the contact of the surface takes over.
//
// Preload: a node that has just been freed leaves each of its copies with the force that keeps its acceleration, on the
// faces between them. It dies away over some hundred steps. It acts while the face holds and while it draws the corner's two
// sides together, q . j >= 0: then its work, -q . j - (what it loses as it dies), is never above zero. Otherwise it would give
// the body energy, where the stress turns round before it has died; in an impact, more than the body has.
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

// The law of a cracked face of a body with this joint, whose penalty is k, Pa/m.
SofteningLaw cohesive_law(const Joint&, double k);

// As face_bond_forces, for the batches of a chunk of a cohesive body. cohesive: its first face first. pull2: written, Pa2, per
// face, the square of what mean_traction has of a face that holds, 0 of others.
void cohesive_face_forces(const FaceBatch*, int faces, const FaceMotion&, const FaceLaw&, const FaceJoints&,
                          bool breaking, FaceStateBatch*, CohesiveFace* cohesive, Node* force, FaceSums&,
                          double* pull2);

// As face_spring; the face stands as `f`.
FaceSpring cohesive_spring(const FaceBatch&, int lane, const FaceFrame& f, int point, const Joint&,
                           const FaceStateBatch&, const CohesiveFace&);

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
std::array<geom::Vec3, 3> carried_tractions(const FaceBatch&, int lane, const FaceFrame&,
                                            const geom::Mat3& stress, const Joint&, FaceStage,
                                            const CohesiveFace&);
// Pa, in space, mean of the points: of a face that cracks, or what the penalty of one that holds adds to that of its stress.
geom::Vec3 mean_traction(const FaceBatch&, int lane, const FaceFrame&, const Joint&, const FaceStateBatch&,
                         const CohesiveFace&);

// Begins a crack on the plane with the unit normal m; a brittle face is broken, in this mode, and lets go in the next step.
// Returns the energy that the face no longer stores, J (negative where it stores more), with the half step's work that its
// traction has done since then and no store has got.
double begin_crack(const FaceBatch&, int lane, const FaceMoment&, const Joint&, const geom::Vec3& m, BondMode,
                   FaceStateBatch&, CohesiveFace&);

// Makes the face a crack without strength along its own plane. It keeps what pressure and friction hold of the traction that
// its sides have now: that of its springs and, Pa, in space, that of `stress` on the face.
void break_face(const Model&, State&, const MeshChunk&, std::int64_t batch, int lane,
                const geom::Mat3& stress);

// A brittle face that has begun to crack carries nothing but contact from now on. The same returned.
double let_go(const FaceBatch&, int lane, const FaceMoment&, const Joint&, FaceStateBatch&, CohesiveFace&);

// Largest damage of its points.
inline double damage_of(const CohesiveFace& face) {
  return std::max({face.damage[0], face.damage[1], face.damage[2]});
}

// Hardly damaged yet: it goes back to holding once it has unloaded; a brittle one lets go.
inline bool may_end(const CohesiveFace& face) {
  constexpr double hardly_damaged = 0.1;
  return damage_of(face) <= hardly_damaged;
}

// Goes back to holding where a face that may end has unloaded. The same returned.
std::optional<double> end_crack(const FaceBatch&, int lane, const FaceMoment&, const Joint&, FaceStateBatch&,
                                CohesiveFace&);

} // namespace cdem
