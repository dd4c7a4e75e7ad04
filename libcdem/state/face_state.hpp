// State of the faces of meshes that may break (bond/face_bonds.hpp, bond/cohesive_faces.hpp).
#pragma once

#include "libcdem/parallel/simd.hpp"

#include <cstdint>

namespace cdem {

// A freed face of a cohesive body.
enum class FaceStage : std::uint8_t {
  holding,  // its sides hold together
  resumed,  // they do so again after a crack that did not go on
  cracking, // a cohesive law acts on its critical plane
  parted,   // it carries nothing
  separated // it has lost its strength and opened: what is left is a contact on its own plane, until its sides have left each other
};

// Springs between its sides act, of a cohesive law or of the contact that is left.
inline bool has_springs(FaceStage stage) {
  return stage == FaceStage::cracking || stage == FaceStage::separated;
}

inline bool holds(FaceStage stage) {
  return stage <= FaceStage::resumed;
}

// A broken face goes over to contact little by little: once its sides have parted or slid away, contacts between them and all
// others around may begin, and the further it has slid, the less of its springs acts, as less of its sides lies on each other.
enum class HandOver : std::uint8_t {
  held,   // its springs act
  done,   // they carry nothing any more
  leaving // what has not let go acts, and contacts may begin
};

// What contact has been told of a face, as a sum. It goes by that until it is told again of the faces of the block: when one
// of them leaves, and where a stage is looked over. So no block is told of for the sake of another.
struct ToldOfFace {
  static constexpr std::uint8_t broken = 1, // one of its springs, at least
      separate = 2,                         // all of them
      left = 4,                             // HandOver is not held
      gone = 8;                             // and is done
};

// The same of an interface between blocks that move far.
enum class ToldOfBonds : std::uint8_t { whole, some_broken, all_broken };

// State of the three springs of eight faces. The place of a spring in the whole array is (batch * 3 + point) * lanes +
// lane.
struct FaceStateBatch {
  std::uint8_t mode[3][lanes];     // BondMode
  std::uint8_t handed_over[lanes]; // HandOver
  FaceStage stage[lanes];          // of cohesive bodies; holding in others
  std::uint8_t preloaded[lanes];   // 1: CohesiveFace::preload has not died away
  std::uint8_t told[lanes];        // ToldOfFace
  double let_go[lanes];            // part of its springs that act no more, of a face that leaves
  std::int32_t slip = -1;          // place in State::face_slip; -1: no spring of the batch is broken
};

// A bit for each face of the batch in this stage.
CDEM_INLINE unsigned faces_in(const FaceStateBatch& state, FaceStage stage) {
  return simd::bits_with(reinterpret_cast<const std::uint8_t*>(state.stage),
                         static_cast<std::uint8_t>(stage));
}

// visit(lane) for each bit set, ascending.
template <class Visit>
CDEM_INLINE void each_lane(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1)
    visit(__builtin_ctz(bits));
}

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

// Slip of the broken springs of a face, by point and axis (along its first edge, across).
struct FaceSlip {
  double value[3][2] = {}; // m, tangential relative displacement at which they carry no shear
  double shear[3][2] = {}; // N, on side a, in the last step
};

// The same of eight faces side by side.
struct FaceSlipBatch {
  double value[3][2][lanes] = {};
  double shear[3][2][lanes] = {};

  FaceSlip at(int lane) const {
    FaceSlip slip;
    for (int point = 0; point < 3; ++point)
      for (int axis = 0; axis < 2; ++axis) {
        slip.value[point][axis] = value[point][axis][lane];
        slip.shear[point][axis] = shear[point][axis][lane];
      }
    return slip;
  }
  void set(int lane, const FaceSlip& slip) {
    for (int point = 0; point < 3; ++point)
      for (int axis = 0; axis < 2; ++axis) {
        value[point][axis][lane] = slip.value[point][axis];
        shear[point][axis][lane] = slip.shear[point][axis];
      }
  }
};

} // namespace cdem
