#include "libcdem/bond/end_of_face.hpp"

#include <algorithm>

namespace cdem {

EndOfFace::EndOfFace(const CohesiveChunk& chunk, int face)
    : chunk_(chunk), of_{chunk.batches[face / lanes], face % lanes, chunk.joints.of(face, room_),
                         chunk.state[face / lanes], chunk.cohesive[face]},
      now_(face_frame(of_.batch, of_.lane, chunk.motion, 0)) {}

FaceFrame EndOfFace::before() const {
  return face_frame(of_.batch, of_.lane, chunk_.motion, chunk_.motion.step);
}

double EndOfFace::separate(const std::array<geom::Vec3, 3>& pull) {
  const FaceFrame then = before();
  double taken = of_.stored(now_);
  for (int point = 0; point < 3; ++point)
    taken -= 0.5 * pull[point].dot(now_.gap[point] - then.gap[point]);
  come_back();
  return taken;
}

void EndOfFace::come_back() {
  for (int point = 0; point < 3; ++point) {
    const geom::Vec3 gap = now_.in_axes(now_.gap[point]);
    of_.face.offset[point] = of_.face.start[point] = {};
    of_.face.slip[point] = {gap.x(), gap.y(), std::min(0.0, gap.z())};
    of_.face.rest[point] = {};
  }
  of_.face.plane = {0, 0, 1};
  of_.state.stage[of_.lane] = FaceStage::separated;
}

void EndOfFace::part() {
  of_.state.stage[of_.lane] = FaceStage::parted;
  if (chunk_.law.hands_over)
    hand_over(of_.lane, of_.state, chunk_.sums);
}

double EndOfFace::leave() {
  const FaceFrame then = before();
  double energy = of_.stored(now_);
  for (int point = 0; point < 3; ++point)
    energy += 0.5 * of_.spring(now_, point).force.dot(now_.gap[point] - then.gap[point]);
  const double lost = cdem::leave(now_, size(), energy, of_.lane, of_.state, chunk_.sums);
  if (handed_over(of_.state, of_.lane))
    of_.state.stage[of_.lane] = FaceStage::parted;
  return lost;
}

} // namespace cdem
