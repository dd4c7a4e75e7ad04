// Faces of cohesive bodies that crack, and those that hold again after a crack that did not go on (bond/freed_face.hpp),
// several side by side.
#pragma once

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/bond/face_joints.hpp"

namespace cdem {

// The faces of a chunk, its first one first.
struct CohesiveChunk {
  const FaceBatch* batches;
  const FaceMotion& motion;
  const FaceJoints& joints;
  const FaceLaw& law;
  bool breaking;
  FaceStateBatch* state;
  CohesiveFace* cohesive;
  Node* force;
  FaceSums& sums;
  double* pull2; // as in cohesive_face_forces
};

// faces: of the chunk, ascending.
void advance_cracking(const CohesiveChunk&, const int* faces, int count);
void hold_resumed(const CohesiveChunk&, const int* faces, int count);

} // namespace cdem
