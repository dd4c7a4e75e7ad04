// Forces of the freed faces of cohesive bodies (bond/freed_face.hpp), chunk by chunk.
//
// Preload: a node that has just been freed leaves each of its copies with the force that keeps its acceleration, on the
// faces between them. It dies away over some hundred steps. It acts while the face holds and while it draws the corner's two
// sides together, q . j >= 0: then its work, -q . j - (what it loses as it dies), is never above zero. Otherwise it would give
// the body energy, where the stress turns round before it has died; in an impact, more than the body has.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/bond/face_joints.hpp"
#include "libcdem/state/cohesive_face.hpp"

namespace cdem {

// As face_bond_forces, for the batches of a chunk of a cohesive body. cohesive: its first face first. pull2: written, Pa2, per
// face, the square of what mean_traction has of a face that holds, 0 of others.
void cohesive_face_forces(const FaceBatch*, int faces, const FaceMotion&, const FaceLaw&, const FaceJoints&,
                          bool breaking, FaceStateBatch*, CohesiveFace* cohesive, Node* force, FaceSums&,
                          double* pull2);

} // namespace cdem
