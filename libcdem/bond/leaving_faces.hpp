// How a broken face of a mesh is handed over to the contact of the surface. Until its sides have parted or slid away, its
// own springs are the contact between them: they know where its sides met, and so close where they opened.
//
//   HandOver   its springs                        from the step on in which
//   held       act                                it is made
//   leaving    act with the part 1 - let_go;      a look is due, none of its bonds is whole, and its sides have parted or
//              contacts may begin                 slid away from each other (is_gone)
//   done       carry nothing                      all its points are open, or it has slid off (let_go = 1)
//
// A face of a cohesive body that has parted is done at once. A body without a contact of its surface hands over nothing.
#pragma once

#include "libcdem/bond/face_frame.hpp"

namespace cdem {

// Parts of a face's size by which its sides have parted, or slid away sideways, at one of its points, where it leaves.
inline constexpr double parted_from = 0.01, slid_from = 0.01;

// Part of its size by which it has slid away where nothing of its springs acts any more.
inline constexpr double slid_off_from = 0.05;

bool is_gone(const FaceFrame&, double size); // size: m

// Such a face leaves, or goes on leaving. size: m, of the face; energy: J, stored in its springs. Returns what of it is lost, J.
double leave(const FaceFrame&, double size, double energy, int lane, FaceStateBatch&, FaceSums&);

void hand_over(int lane, FaceStateBatch&, FaceSums&); // at once

} // namespace cdem
