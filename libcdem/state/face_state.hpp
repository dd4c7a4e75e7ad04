// State of the faces of meshes that may break (bond/face_bonds.hpp, bond/cohesive_faces.hpp).
#pragma once

#include "libcdem/parallel/node.hpp"

#include <cstdint>

namespace cdem {

// A freed face of a cohesive body.
enum class FaceStage : std::uint8_t {
  holding,  // its sides hold together
  resumed,  // they do so again after a crack that did not go on
  cracking, // a cohesive law acts on its working plane
  parted    // it carries nothing
};

inline bool holds(FaceStage stage) {
  return stage <= FaceStage::resumed;
}

// A broken face goes over to contact in two steps: in the first the contacts of its two triangles begin, without force,
// beside its springs; in the next one they take over the force of the springs (contact/response/taken_over.hpp).
enum class HandOver : std::uint8_t {
  held,    // its springs act
  done,    // they carry nothing any more
  leaving, // they act, and contacts may begin
  loose    // they act, none of its bonds is whole: its sides may touch others (contact/pairs/tet_joints.hpp)
};

// State of the three springs of eight faces. The place of a spring in the whole array is (batch * 3 + point) * lanes +
// lane.
struct FaceStateBatch {
  std::uint8_t mode[3][lanes];     // BondMode
  std::uint8_t handed_over[lanes]; // HandOver
  FaceStage stage[lanes];          // of cohesive bodies; holding in others
  std::uint8_t preloaded[lanes];   // 1: CohesiveFace::preload has not died away
  std::int32_t slip; // of the first lane in State::face_slip; -1: no spring of the batch is broken
};

// The springs carry nothing any more: what meets there is found by search (contact/).
inline bool handed_over(const FaceStateBatch& state, int lane) {
  return state.handed_over[lane] == static_cast<std::uint8_t>(HandOver::done);
}
inline bool leaves(const FaceStateBatch& state, int lane) {
  return state.handed_over[lane] == static_cast<std::uint8_t>(HandOver::leaving);
}
inline void set_hand_over(FaceStateBatch& state, int lane, HandOver to) {
  state.handed_over[lane] = static_cast<std::uint8_t>(to);
}

// m, tangential relative displacement at which the broken springs of a face carry no shear: point; along its first
// edge, across.
struct FaceSlip {
  double value[3][2] = {};
};

} // namespace cdem
