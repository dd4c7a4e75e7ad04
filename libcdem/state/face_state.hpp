// How the springs of the bonded faces of meshes stand (bond/face_bonds.hpp).
#pragma once

#include "libcdem/parallel/node.hpp"

#include <cstdint>

namespace cdem {

// Of the three springs of eight faces; a spring's place in the whole is (batch * 3 + point) * lanes + lane.
struct FaceStateBatch {
  std::uint8_t mode[3][lanes];     // BondMode
  std::uint8_t handed_over[lanes]; // 1: the springs carry nothing any more
  std::int32_t slip; // of the first lane in State::face_slip; -1: no spring of the batch is broken
};

// Its sides have parted since it broke: what meets there is found by search (contact/).
inline bool handed_over(const FaceStateBatch& state, int lane) {
  return state.handed_over[lane] != 0;
}

// m, tangential gap at which the broken springs of a face carry no shear: point; along its first edge, across.
struct FaceSlip {
  double value[3][2] = {};
};

} // namespace cdem
