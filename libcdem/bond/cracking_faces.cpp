#include "libcdem/bond/cracking_faces.hpp"

#include "libcdem/bond/broken_faces.hpp"
#include "libcdem/bond/cohesive_faces.hpp"
#include "libcdem/bond/cohesive_law.hpp"
#include "libcdem/bond/sliding_faces.hpp"

#include <algorithm>
#include <cstddef>

namespace cdem {
namespace {

using simd::MaskOf;
using simd::width;

// The faces that are computed together; lanes from `count` on repeat the last face, and what they give is dropped.
template <class V>
struct Group {
  int count = 0;
  int face[width<V>], a[3][width<V>], b[3][width<V>]; // and its nodes' places
  V area, k;                                          // m2, a third of a face, of which its springs act; Pa/m
};

template <class V>
CDEM_INLINE Group<V> group_of(const CohesiveChunk& chunk, const int* faces, int count) {
  Group<V> g;
  g.count = std::min(count, width<V>);
  V kn, let_go;
  for (int lane = 0; lane < width<V>; ++lane) {
    const int face = g.face[lane] = faces[std::min(lane, g.count - 1)];
    const FaceBatch& batch = chunk.batches[face / lanes];
    for (int corner = 0; corner < 3; ++corner) {
      g.a[corner][lane] = batch.place_a[corner][face % lanes];
      g.b[corner][lane] = batch.place_b[corner][face % lanes];
    }
    g.area[lane] = batch.area[face % lanes];
    kn[lane] = batch.kn[face % lanes];
    let_go[lane] = chunk.state[face / lanes].let_go[face % lanes];
  }
  g.k = kn / g.area;
  g.area *= 1.0 - let_go;
  return g;
}

// The faces of a group, with all that they remember, side by side. A face's numbers stand one behind the other
// (state/cohesive_face.hpp): they are read and written in runs as long as a vector, and turned over.
template <class V>
class Memories {
  static constexpr int offset = offsetof(CohesiveFace, offset) / sizeof(double),
                       start = offsetof(CohesiveFace, start) / sizeof(double),
                       drawn = offsetof(CohesiveFace, drawn) / sizeof(double),
                       rest = offsetof(CohesiveFace, rest) / sizeof(double),
                       damage = offsetof(CohesiveFace, damage) / sizeof(double),
                       slip = offsetof(CohesiveFace, slip) / sizeof(double),
                       preload = offsetof(CohesiveFace, preload) / sizeof(double),
                       read = (preload + 7) / 8 * 8;
  static_assert(offsetof(CohesiveFace, plane) == 0 && offset < start && start < drawn && drawn < rest &&
                    rest < damage && damage < slip && slip < preload &&
                    read * sizeof(double) <= sizeof(CohesiveFace),
                "runs are read up to the preload and not beyond the face");

public:
  static constexpr int of_offsets = start; // as many numbers have the offsets, and those before them

  // Those before the preload, or as many as asked for, in whole runs.
  CDEM_INLINE Memories(const CohesiveFace* faces, const Group<V>& g, int numbers = preload) : g_(g) {
    for (int first = 0; first < numbers; first += width<V>) {
      V run[width<V>];
      for (int lane = 0; lane < width<V>; ++lane)
        run[lane] = simd::load_wide<V>(numbers_of(faces[g.face[lane]]) + first);
      simd::transpose(run);
      for (int i = 0; i < width<V>; ++i)
        at_[first + i] = run[i];
    }
  }

  CDEM_INLINE Triple<V> offset_of(int point) const { return triple_at(offset + 3 * point); }
  CDEM_INLINE CohesivePoint<V> point(int p) const {
    return {triple_at(0),
            offset_of(p),
            triple_at(start + 3 * p),
            triple_at(rest + 3 * p),
            triple_at(slip + 3 * p),
            at_[damage + p],
            at_[drawn + p]};
  }

  CDEM_INLINE void advance(int p, const CohesiveResponse<V>& r) {
    at_[damage + p] = r.damage;
    at_[drawn + p] = r.drawn;
    at_[slip + 3 * p] = r.slip.x;
    at_[slip + 3 * p + 1] = r.slip.y;
    at_[slip + 3 * p + 2] = r.slip.z;
  }

  // Writes the runs in which something advances.
  CDEM_INLINE void keep(CohesiveFace* faces) const {
    for (int first = 0; first < preload; first += width<V>) {
      const auto meets = [&](int begin, int end) { return first < end && begin < first + width<V>; };
      if (!meets(drawn, rest) && !meets(damage, preload))
        continue;
      V run[width<V>];
      for (int i = 0; i < width<V>; ++i)
        run[i] = at_[first + i];
      simd::transpose(run);
      for (int lane = 0; lane < g_.count; ++lane)
        simd::store_wide<V>(numbers_of(faces[g_.face[lane]]) + first, run[lane]);
    }
  }

private:
  template <class Face>
  CDEM_INLINE static auto numbers_of(Face& face) {
    return face.plane.data();
  }
  CDEM_INLINE Triple<V> triple_at(int i) const { return {at_[i], at_[i + 1], at_[i + 2]}; }

  const Group<V>& g_;
  V at_[read];
};

// Faces at one moment.
template <class V>
struct Stand {
  FramesOfFaces<V> frame;
  Triple<V> gap[3]; // m, at the points, in the axes of each face

  CDEM_INLINE Triple<V> in_space(const Triple<V>& v) const {
    return v.x * frame.along + v.y * frame.across + v.z * frame.normal;
  }
};

// Now, and as long ago as the last step lasted.
template <class V>
struct Stands {
  Stand<V> now, before;
};

template <class V>
CDEM_INLINE Stand<V> stand_of(const Triple<V> (&x)[3], const Triple<V> (&d)[3]) {
  Stand<V> s;
  s.frame = frames_of_faces<V>(x, d);
  const V half = V{} + 0.5, sixth = V{} + 1.0 / 6;
  const Triple<V> common = sixth * (d[0] + d[1] + d[2]);
  for (int point = 0; point < 3; ++point) {
    const Triple<V> gap = common + half * d[point];
    s.gap[point] = {dot(gap, s.frame.along), dot(gap, s.frame.across), dot(gap, s.frame.normal)};
  }
  return s;
}

template <class V, bool with_before>
CDEM_INLINE Stands<V> stands_of(const Group<V>& g, const FaceMotion& motion) {
  Triple<V> x[3], d[3];
  for (int corner = 0; corner < 3; ++corner) {
    x[corner] = simd::gather_wide<V>(motion.position, g.a[corner]);
    d[corner] = simd::gather_wide<V>(motion.displacement, g.b[corner]) -
                simd::gather_wide<V>(motion.displacement, g.a[corner]);
  }
  Stands<V> s;
  s.now = stand_of<V>(x, d);
  if constexpr (with_before) {
    const V step = V{} + motion.step;
    for (int corner = 0; corner < 3; ++corner) {
      const Triple<V> va = simd::gather_wide<V>(motion.velocity, g.a[corner]),
                      vb = simd::gather_wide<V>(motion.velocity, g.b[corner]);
      x[corner] = x[corner] - step * va;
      d[corner] = d[corner] - step * (vb - va);
    }
    s.before = stand_of<V>(x, d);
  }
  return s;
}

// What the points of faces pull with (N, in space), shared out to their corners, face by face.
template <class V>
CDEM_INLINE void share(const Group<V>& g, const Triple<V> (&pull)[3], Node* force) {
  const V half = V{} + 0.5, sixth = V{} + 1.0 / 6;
  const Triple<V> common = sixth * (pull[0] + pull[1] + pull[2]);
  Triple<V> at[3];
  for (int corner = 0; corner < 3; ++corner)
    at[corner] = common + half * pull[corner];
  for (int lane = 0; lane < g.count; ++lane)
    for (int corner = 0; corner < 3; ++corner) {
      const simd::Quad f = {at[corner].x[lane], at[corner].y[lane], at[corner].z[lane], 0};
      Node &a = force[g.a[corner][lane]], &b = force[g.b[corner][lane]];
      simd::store(a, simd::load(a) + f);
      simd::store(b, simd::load(b) - f);
    }
}

template <class V>
CDEM_INLINE MaskOf<V> everywhere(bool value) {
  return MaskOf<V>{} - static_cast<std::int64_t>(value);
}

// The joint that all faces have, read once.
template <class V>
CDEM_INLINE SofteningJoint<V> joint_of_all(const CohesiveChunk& chunk) {
  Joint room;
  const SofteningJoint<double> one = softening_values(chunk.joints.of(0, room), chunk.tan_friction);
  const V none{};
  return {everywhere<V>(one.softens),  everywhere<V>(one.exponential),
          none + one.cohesion,         none + one.tan_friction,
          none + one.tensile_strength, none + one.energy_1,
          none + one.energy_2,         none + one.area};
}

template <class V>
CDEM_INLINE SofteningJoint<V> joints_of(const CohesiveChunk& chunk, const Group<V>& g) {
  SofteningJoint<V> joint;
  for (int lane = 0; lane < width<V>; ++lane) {
    Joint room;
    const Joint& own = chunk.joints.of(g.face[lane], room);
    const SofteningJoint<double> one =
        softening_values(own, chunk.joints.tan_friction(g.face[lane], chunk.tan_friction));
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

// What happens seldom, to one face: its springs act for the last time.
class EndOfFace {
public:
  EndOfFace(const CohesiveChunk& chunk, int face)
      : chunk_(chunk), batch_(chunk.batches[face / lanes]), lane_(face % lanes), face_(face),
        state_(chunk.state[face / lanes]), cohesive_(chunk.cohesive[face]),
        now_(face_frame(batch_, lane_, chunk.motion, 0)) {}

  bool gone() const { return is_gone(now_, std::sqrt(3 * batch_.area[lane_])); }

  // It has lost its strength and opened: what it still stores, J, is let go of, less the half step of work that its pull (N,
  // at its points) would have done. From now on it is a contact on its own plane, which closes where its sides stand now,
  // or at a gap of zero if they are further apart.
  double separate(const std::array<geom::Vec3, 3>& pull) { // J, what breaking takes
    const FaceFrame before = face_frame(batch_, lane_, chunk_.motion, chunk_.motion.step);
    double taken = stored();
    for (int point = 0; point < 3; ++point) {
      taken -= 0.5 * pull[point].dot(now_.gap[point] - before.gap[point]);
      const geom::Vec3 gap = now_.in_axes(now_.gap[point]);
      cohesive_.offset[point] = cohesive_.start[point] = {};
      cohesive_.slip[point] = {gap.x(), gap.y(), std::min(0.0, gap.z())};
      cohesive_.rest[point] = {};
    }
    cohesive_.plane = {0, 0, 1};
    state_.stage[lane_] = FaceStage::separated;
    return taken;
  }

  // Nothing is between its sides any more.
  void end() {
    state_.stage[lane_] = FaceStage::parted;
    if (!chunk_.hands_over)
      return;
    set_hand_over(state_, lane_, HandOver::done);
    chunk_.sums.hands_over = true;
  }

  // Contacts around it may begin; its springs let go by and by.
  double leave() { // J, lost
    const FaceFrame before = face_frame(batch_, lane_, chunk_.motion, chunk_.motion.step);
    double energy = stored();
    for (int point = 0; point < 3; ++point)
      energy += 0.5 * spring(point).force.dot(now_.gap[point] - before.gap[point]);
    const double lost =
        cdem::let_go(now_, std::sqrt(3 * batch_.area[lane_]), energy, lane_, state_, chunk_.sums);
    if (handed_over(state_, lane_))
      state_.stage[lane_] = FaceStage::parted;
    return lost;
  }

private:
  double stored() const { // J
    double energy = 0;
    for (int point = 0; point < 3; ++point)
      energy += spring(point).energy;
    return energy;
  }

  FaceSpring spring(int point) const {
    Joint room;
    return cohesive_spring(batch_, lane_, now_, point, chunk_.joints.of(face_, room), state_, cohesive_);
  }

  const CohesiveChunk& chunk_;
  const FaceBatch& batch_;
  int lane_, face_;
  FaceStateBatch& state_;
  CohesiveFace& cohesive_;
  FaceFrame now_;
};

CDEM_INLINE int first_of(unsigned bits) {
  return __builtin_ctz(bits);
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
  const Group<V> g = group_of<V>(chunk, faces, count);
  const unsigned used = (1u << g.count) - 1;
  const V k = crack_stiffness * g.k;
  const SofteningLawOf<V> law = softening_law<V>(chunk.joints.alike() ? joint_of_all : joints_of<V>(chunk, g),
                                                 k, k, SofteningBegins::at_strength);
  Memories<V> memories(chunk.cohesive, g);
  const Stands<V> s = stands_of<V, true>(g, chunk.motion);
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
      const int lane = first_of(bits);
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
               leaving = leaves(state, g.face[lane] % lanes), may_leave = lost && chunk.due;
    if (!separates && !may_leave)
      continue;
    EndOfFace end(chunk, g.face[lane]);
    if (separates) {
      breaking[lane] +=
          end.separate({lane_of(pull[0], lane), lane_of(pull[1], lane), lane_of(pull[2], lane)});
      let_go |= 1u << lane;
    } else if (leaving || end.gone()) {
      if (opened_now)
        end.end();
      else if (chunk.hands_over)
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
  share<V>(g, pull, chunk.force);
}

template <class V>
CDEM_INLINE void hold_group(const CohesiveChunk& chunk, const int* faces, int count) {
  for (int i = width<V>; i < std::min(count, 2 * width<V>); ++i)
    simd::prefetch(&chunk.cohesive[faces[i]], sizeof(double) * Memories<V>::of_offsets);
  const Group<V> g = group_of<V>(chunk, faces, count);
  const Stand<V> now = stands_of<V, false>(g, chunk.motion).now;
  const V kn = g.k * g.area;
  const Memories<V> memories(chunk.cohesive, g, Memories<V>::of_offsets);
  Triple<V> pull[3];
  for (int point = 0; point < 3; ++point) {
    const Triple<V> w0 = memories.offset_of(point);
    pull[point] = now.in_space(kn * (now.gap[point] + w0));
  }
  const Triple<V> mean = (1.0 / 3) / g.area * (pull[0] + pull[1] + pull[2]);
  const V square = dot(mean, mean);
  for (int lane = 0; lane < g.count; ++lane)
    chunk.pull2[g.face[lane]] = square[lane];
  share<V>(g, pull, chunk.force);
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
