#include "libcdem/bond/leaving_faces.hpp"

#include <algorithm>

namespace cdem {
namespace {

// m, by how much a point of the face has slid away.
double slid_by(const FaceFrame& f, const geom::Vec3& gap) {
  return f.in_axes(gap).head<2>().norm();
}

// Part of the springs of a face that leaves which has let go. size: m.
double let_go_of(const FaceFrame& f, double size) {
  double slid = 0; // m
  for (const geom::Vec3& gap : f.gap)
    slid = std::max(slid, slid_by(f, gap));
  return std::clamp((slid / size - slid_from) / (slid_off_from - slid_from), 0.0, 1.0);
}

} // namespace

bool is_gone(const FaceFrame& f, double size) {
  return std::any_of(f.gap.begin(), f.gap.end(), [&](const geom::Vec3& gap) {
    return f.in_axes(gap)[2] > parted_from * size || slid_by(f, gap) > slid_from * size;
  });
}

bool is_back(const FaceFrame& f, double size) {
  return !f.torn && std::all_of(f.gap.begin(), f.gap.end(), [&](const geom::Vec3& gap) {
    const double opening = f.in_axes(gap)[2];
    return opening > 0 && opening < back_from * size && slid_by(f, gap) < slid_back_from * size;
  });
}

double leave(const FaceFrame& f, double size, double energy, int lane, FaceStateBatch& state,
             FaceSums& sums) {
  const bool open =
      std::all_of(f.gap.begin(), f.gap.end(), [&](const geom::Vec3& gap) { return f.in_axes(gap)[2] > 0; });
  double& part = state.let_go[lane];
  const double before = part;
  part = open ? 1 : std::max(before, let_go_of(f, size));
  if (part >= 1)
    hand_over(lane, state, sums);
  else if (!leaves(state, lane)) {
    set_hand_over(state, lane, HandOver::leaving);
    sums.hands_over = true;
  }
  return (part - before) / (1 - before) * energy;
}

void hand_over(int lane, FaceStateBatch& state, FaceSums& sums) {
  set_hand_over(state, lane, HandOver::done);
  sums.hands_over = true;
}

} // namespace cdem
