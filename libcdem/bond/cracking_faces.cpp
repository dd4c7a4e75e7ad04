#include "libcdem/bond/cracking_faces.hpp"

#include "libcdem/bond/end_of_face.hpp"
#include "libcdem/bond/face_groups.hpp"

namespace cdem {
namespace {

using simd::MaskOf;
using simd::width;

template <class V>
CDEM_INLINE MaskOf<V> everywhere(bool value) {
  return MaskOf<V>{} - static_cast<std::int64_t>(value);
}

// The joint that all faces have, read once.
template <class V>
CDEM_INLINE SofteningJoint<V> joint_of_all(const CohesiveChunk& chunk) {
  Joint room;
  const SofteningJoint<double> one = softening_values(chunk.joints.of(0, room), chunk.law.tan_friction);
  const V none{};
  return {everywhere<V>(one.softens),  everywhere<V>(one.exponential),
          none + one.cohesion,         none + one.tan_friction,
          none + one.tensile_strength, none + one.energy_1,
          none + one.energy_2,         none + one.area};
}

template <class V>
CDEM_INLINE SofteningJoint<V> joints_of(const CohesiveChunk& chunk, const FaceGroup<V>& g) {
  SofteningJoint<V> joint;
  for (int lane = 0; lane < width<V>; ++lane) {
    Joint room;
    const Joint& own = chunk.joints.of(g.face[lane], room);
    const SofteningJoint<double> one =
        softening_values(own, chunk.joints.tan_friction(g.face[lane], chunk.law.tan_friction));
    joint.softens[lane] = -static_cast<std::int64_t>(one.softens);
    joint.exponential[lane] = -static_cast<std::int64_t>(one.exponential);
    joint.cohesion[lane] = one.cohesion;
    joint.tan_friction[lane] = one.tan_friction;
    joint.tensile_strength[lane] = one.tensile_strength;
    joint.energy_1[lane] = one.energy_1;
    joint.energy_2[lane] = one.energy_2;
    joint.area[lane] = one.area;
  }
  return joint;
}

template <class V>
CDEM_INLINE geom::Vec3 lane_of(const Triple<V>& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}

// A point that has lost its strength in this step. began: Pa, across m, what it began with.
void tell_broken(const CohesiveChunk& chunk, int face, int point, const geom::Vec3& m_in_space,
                 const geom::Vec3& m, const geom::Vec3& began, BondMode how) {
  std::uint8_t& mode = chunk.state[face / lanes].mode[point][face % lanes];
  if (!is_intact(mode))
    return;
  mode = static_cast<std::uint8_t>(how);
  const std::int64_t spring = (std::int64_t{face / lanes} * 3 + point) * lanes + face % lanes;
  chunk.sums.broken.push_back(
      {spring, how, m_in_space, began.dot(m), (began - began.dot(m) * m).norm(), {}, {}});
}

template <class V>
CDEM_INLINE void advance_group(const CohesiveChunk& chunk, const SofteningJoint<V>& joint_of_all,
                               const int* faces, int count) {
  using T3 = Triple<V>;
  const V none{}, one = none + 1.0;
  const FaceGroup<V> g = face_group<V>(chunk, faces, count);
  const unsigned used = (1u << g.count) - 1;
  const V k = crack_stiffness * g.k;
  const SofteningLawOf<V> law = softening_law<V>(chunk.joints.alike() ? joint_of_all : joints_of<V>(chunk, g),
                                                 k, k, SofteningBegins::at_strength);
  FaceMemories<V> memories(chunk.cohesive, g);
  const FacesNowAndBefore<V> s = faces_now_and_before<V, true>(g, chunk.motion);
  const MaskOf<V> grows = everywhere<V>(chunk.breaking);
  T3 pull[3], m, began[3];
  V friction{}, breaking{}, tension{}, shear{};
  MaskOf<V> without = everywhere<V>(true), open = without;
  unsigned ended[3], opened[3];
  for (int point = 0; point < 3; ++point) {
    // A third of the next group, while this one is computed: more than the processor can fetch at a time.
    for (int i = width<V> + point; i < std::min(count, 2 * width<V>); i += 3)
      simd::prefetch(&chunk.cohesive[faces[i]], sizeof(CohesiveFace));
    const CohesivePoint<V> at = memories.point(point);
    const T3 &gap = s.now.gap[point], &gap0 = s.before.gap[point];
    const CohesiveResponse<V> r = cohesive_response<V>(law, at, gap, grows, s.now.frame.torn);
    const SofteningLoss<V> lost = cohesive_loss<V>(law, at, gap0, gap, r);
    const MaskOf<V> damaged = simd::below<V>(none, r.damage); // nothing is lost while it is whole
    const V facing = g.area * at.plane.z, grown = r.damage - at.damage;
    const V taken = facing * (damaged ? lost.breaking : none);
    // What the point loses goes by the trapezoidal rule.
    friction += damaged ? facing * lost.friction : none;
    breaking += taken + 0.5 * g.area * grown * dot(at.rest, (gap - at.start) + (gap0 - at.start));
    const V into_crack = simd::below<V>(none, grown) & simd::below<V>(none, taken) ? taken : none,
            share_of_shear = shear_share<V>(law, at.plane, r.stretch);
    shear += share_of_shear * into_crack;
    tension += (1.0 - share_of_shear) * into_crack;
    const MaskOf<V> no_traction = simd::equal<V>(r.across.x, none) & simd::equal<V>(r.across.y, none) &
                                  simd::equal<V>(r.across.z, none);
    const MaskOf<V> lost_all = simd::at_most<V>(one, r.damage);
    without &= lost_all;
    open &= no_traction;
    ended[point] = simd::bits_of(lost_all) & used;
    opened[point] = simd::bits_of(MaskOf<V>((!r.separated) | r.opens));
    began[point] = law.kn * at.offset;
    m = at.plane;
    pull[point] = s.now.in_space(g.area * r.traction);
    memories.advance(point, r);
  }
  memories.keep(chunk.cohesive);
  if (const unsigned any_ended = ended[0] | ended[1] | ended[2]; any_ended != 0) {
    const T3 m_in_space = s.now.in_space(m);
    for (unsigned bits = any_ended; bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      for (int point = 0; point < 3; ++point)
        if ((ended[point] >> lane & 1) != 0)
          tell_broken(chunk, g.face[lane], point, lane_of(m_in_space, lane), lane_of(m, lane),
                      lane_of(began[point], lane),
                      (opened[point] >> lane & 1) != 0 ? BondMode::broken_tension : BondMode::broken_shear);
    }
  }
  const unsigned bits_without = simd::bits_of(without) & used, bits_open = simd::bits_of(open);
  unsigned let_go = 0;
  for (int lane = 0; lane < g.count; ++lane) {
    const FaceStateBatch& state = chunk.state[g.face[lane] / lanes];
    const bool lost = (bits_without >> lane & 1) != 0, opened_now = lost && (bits_open >> lane & 1) != 0,
               separates = opened_now && state.stage[g.face[lane] % lanes] == FaceStage::cracking,
               leaving = leaves(state, g.face[lane] % lanes), may_leave = lost && chunk.law.hand_over_due;
    if (!separates && !may_leave)
      continue;
    EndOfFace end(chunk, g.face[lane]);
    if (separates) {
      breaking[lane] +=
          end.separate({lane_of(pull[0], lane), lane_of(pull[1], lane), lane_of(pull[2], lane)});
      let_go |= 1u << lane;
    } else if (leaving || end.gone()) {
      if (opened_now)
        end.part();
      else if (chunk.law.hands_over)
        friction[lane] += end.leave();
    }
  }
  FaceSums& sums = chunk.sums;
  for (int lane = 0; lane < g.count; ++lane) {
    sums.friction += friction[lane];
    sums.breaking += breaking[lane];
    sums.crack += CrackEnergy{tension[lane], shear[lane]};
  }
  if (let_go != 0) {
    const MaskOf<V> parted = simd::lanes_of<V>(let_go);
    for (T3& p : pull)
      p = chosen(parted, T3{}, p);
  }
  share_to_corners<V>(g, pull, chunk.force);
}

template <class V>
CDEM_INLINE void hold_group(const CohesiveChunk& chunk, const int* faces, int count) {
  for (int i = width<V>; i < std::min(count, 2 * width<V>); ++i)
    simd::prefetch(&chunk.cohesive[faces[i]], sizeof(double) * FaceMemories<V>::of_offsets);
  const FaceGroup<V> g = face_group<V>(chunk, faces, count);
  const FacesNow<V> now = faces_now_and_before<V, false>(g, chunk.motion).now;
  const V kn = g.k * g.area;
  const FaceMemories<V> memories(chunk.cohesive, g, FaceMemories<V>::of_offsets);
  Triple<V> pull[3];
  for (int point = 0; point < 3; ++point) {
    const Triple<V> w0 = memories.offset_of(point);
    pull[point] = now.in_space(kn * (now.gap[point] + w0));
  }
  const Triple<V> mean = (1.0 / 3) / g.area * (pull[0] + pull[1] + pull[2]);
  const V square = dot(mean, mean);
  for (int lane = 0; lane < g.count; ++lane)
    chunk.pull2[g.face[lane]] = square[lane];
  share_to_corners<V>(g, pull, chunk.force);
}

template <class V>
CDEM_INLINE void cracking_kernel(const CohesiveChunk& chunk, const int* faces, int count) {
  const SofteningJoint<V> joint = chunk.joints.alike() ? joint_of_all<V>(chunk) : SofteningJoint<V>{};
  for (int i = 0; i < count; i += width<V>)
    advance_group<V>(chunk, joint, faces + i, count - i);
}

template <class V>
CDEM_INLINE void resumed_kernel(const CohesiveChunk& chunk, const int* faces, int count) {
  for (int i = 0; i < count; i += width<V>)
    hold_group<V>(chunk, faces + i, count - i);
}

} // namespace

void advance_cracking(const CohesiveChunk& chunk, const int* faces, int count) {
  simd::best_width<cracking_kernel<simd::Oct>, cracking_kernel<simd::Quad>>(chunk, faces, count);
}

void hold_resumed(const CohesiveChunk& chunk, const int* faces, int count) {
  simd::best_width<resumed_kernel<simd::Oct>, resumed_kernel<simd::Quad>>(chunk, faces, count);
}

} // namespace cdem
