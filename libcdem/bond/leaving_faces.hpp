// How a broken face of a mesh is handed over to the contact of the surface, and taken back. Until its sides have parted or slid
// away, its own springs are the contact between them: they know where its sides met, and so close where they opened.
//
//   HandOver   its springs                        from the step on in which
//   held       act                                it is made
//   leaving    act with the part 1 - let_go;      a look is due, none of its bonds is whole, and its sides have parted or
//              contacts may begin                 slid away from each other (is_gone)
//   done       carry nothing                      all its points are open, or it has slid off (let_go = 1)
//   held       act                                a look is due, and its sides stand open where they met (is_back)
//
// A face is taken back before it closes, so it stores nothing then and no force jumps. On sides that close where they met, pairs
// of tetrahedra would press beside the corners alone: the surface would seem rough (docs/contact-details.md, section 8).
//
// A face of a cohesive body that has parted is done at once. A body without a contact of its surface hands over nothing.
#pragma once

#include "libcdem/bond/face_frame.hpp"

namespace cdem {

// Parts of a face's size by which its sides have parted, or slid away sideways, at one of its points, where it leaves.
inline constexpr double parted_from = 0.01, slid_from = 0.01;

// Part of its size by which it has slid away where nothing of its springs acts any more.
inline constexpr double slid_off_from = 0.05;

// Parts of its size by which its sides are apart, and have slid, at most, at all its points, where it is taken back.
inline constexpr double back_from = 0.009, slid_back_from = 0.005;

bool is_gone(const FaceFrame&, double size); // size: m
bool is_back(const FaceFrame&, double size);

// Such a face leaves, or goes on leaving. size: m, of the face; energy: J, stored in its springs. Returns what of it is lost, J.
double leave(const FaceFrame&, double size, double energy, int lane, FaceStateBatch&, FaceSums&);

void hand_over(int lane, FaceStateBatch&, FaceSums&); // at once

// takes_back(face, frame) for each of the faces that have been handed over and are back; then their springs act.
template <class TakesBack>
void take_back(const FaceBatch* batches, int faces, const FaceMotion& motion, FaceStateBatch* state,
               FaceSums& sums, const TakesBack& takes_back) {
  for (int first = 0; first < faces; first += lanes) {
    FaceStateBatch& at = state[first / lanes];
    const unsigned used = (1u << std::min(faces - first, lanes)) - 1;
    each_lane(simd::bits_with(at.handed_over, static_cast<std::uint8_t>(HandOver::done)) & used,
              [&](int lane) {
                const FaceBatch& batch = batches[first / lanes];
                const FaceFrame now = face_frame(batch, lane, motion, 0);
                if (!is_back(now, std::sqrt(3 * batch.area[lane])))
                  return;
                takes_back(first + lane, now);
                at.let_go[lane] = 0;
                set_hand_over(at, lane, HandOver::held);
                sums.hands_over = true;
              });
  }
}

} // namespace cdem
