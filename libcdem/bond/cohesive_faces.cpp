#include "libcdem/bond/cohesive_faces.hpp"

#include "libcdem/parallel/simd.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

using geom::Vec3;

// Part of a preload that dies in a step, and what of a face's strength is too little to keep.
constexpr double dying = 1.0 / 200, too_little = 1e-6;
// Work that a preload q may do on its face's sides before it ends, over q^2 / (k A).
constexpr double pushing = 0.01;
// A crack ends where less than this part of its strength is asked of it and less than that part of it is damaged.
constexpr double unloaded = 0.97, hardly_damaged = 0.1;

Vec3 vec(const CohesiveFace::Vector& v) {
  return {v[0], v[1], v[2]};
}
CohesiveFace::Vector array(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

double penalty(const FaceBatch& batch, int lane) { // k, Pa/m
  return batch.kn[lane] / batch.area[lane];
}

// The laws of cracked faces of a chunk, but for the lengths that hang on the penalty of each.
struct ChunkLaw {
  const FaceJoints& joints;
  double tan_friction; // of faces without a strength of their own
  // face: from the chunk's first on.
  SofteningLaw at(const FaceBatch& batch, int face) const {
    Joint room;
    const double k = penalty(batch, face % lanes);
    return softening_law(joints.of(face, room), joints.tan_friction(face, tan_friction), k, k,
                         SofteningBegins::at_strength);
  }
};

void add(Node* force, int place, const Vec3& f) {
  force[place].x += f.x();
  force[place].y += f.y();
  force[place].z += f.z();
}

// What one point of a cracking face gives, per area.
struct PointResponse {
  Vec3 traction = Vec3::Zero(); // Pa, on side a, in the face's axes
  SofteningResponse law;
};

PointResponse respond(const SofteningLaw& law, const CohesiveFace& face, int point, const Vec3& gap,
                      bool grows) {
  PointResponse r;
  const Vec3 m = vec(face.plane);
  r.law = softening_response(law, m, gap + vec(face.offset[point]), face.damage[point], vec(face.slip[point]),
                             grows && law.softens());
  r.traction = m[2] * r.law.traction + (1 - r.law.damage) * vec(face.rest[point]);
  return r;
}

// Energies of one point of a cracking face, J per area. The law begins stretched by w0 = offset (+ a gap of next to nothing),
// as if its spring had been drawn there: k w0^2 / 2, which the body never stored. Damage can take
//   P = k (<w0_n>^2 + <|w0_s| - friction>^2) / 2
// of it. The rest, of pressure and friction, goes with the last of the strength, as D^8: where damage takes most per D. So a
// face that has lost its strength stores what its contact stores, and what breaking takes grows all along. The springs of a
// brittle face, which loses its strength at once, keep this rest until it parts.
double taken_by_damage(const SofteningLaw& law, const Vec3& m, const Vec3& offset) {
  const double open = offset.dot(m), shear = (offset - open * m).norm();
  const double slip = std::max(0.0, shear - friction_limit(std::max(0.0, -open), law.strength.tan_friction));
  return 0.5 * law.kn * (std::max(0.0, open) * std::max(0.0, open) + slip * slip);
}

double never_stored(const SofteningLaw& law, const Vec3& m, const Vec3& offset, double damage) {
  const double all = 0.5 * law.kn * offset.squaredNorm(), taken = taken_by_damage(law, m, offset);
  const double d2 = damage * damage, d4 = d2 * d2, late = law.softens() ? d4 * d4 : 0;
  return all - damage * taken - late * (all - taken);
}

// r0 stores (1 - D) r0.j.
double stored_at(const SofteningLaw& law, const CohesiveFace& face, int point, const Vec3& stretch,
                 const SofteningResponse& now) {
  const Vec3 m = vec(face.plane), offset = vec(face.offset[point]);
  return m[2] * (softening_stored(law, m, stretch, now.damage, now.contact) -
                 never_stored(law, m, offset, now.damage)) +
         (1 - now.damage) * vec(face.rest[point]).dot(stretch - offset);
}

// What the three points of a face pull with (N, in space), shared out to its corners.
void share(const FaceNodes& at, const Vec3 (&pull)[3], Node* force) {
  const std::array<Vec3, 3> at_corner = at_corners(pull);
  for (int corner = 0; corner < 3; ++corner) {
    add(force, at.a[corner], at_corner[corner]);
    add(force, at.b[corner], -at_corner[corner]);
  }
}

// A face that cracks, in a step.
class CrackingFace {
public:
  CrackingFace(const FaceBatch& batch, int lane, const FaceMotion& motion, const SofteningLaw& law,
               FaceStateBatch& state, CohesiveFace& face)
      : batch_(batch), lane_(lane), state_(state), face_(face), law_(law),
        now_(face_frame(batch, lane, motion, 0)), before_(face_frame(batch, lane, motion, motion.step)) {}

  // spring: the place of the face's first point.
  void advance(bool breaking, std::int64_t spring, bool to_contact, Node* force, FaceSums& sums) {
    Vec3 pull[3];
    bool without = true, open = true;
    for (int point = 0; point < 3; ++point) {
      pull[point] = advance_point(point, breaking, spring + point * lanes, sums, open);
      without = without && face_.damage[point] >= 1;
    }
    if (without && to_contact)
      come_loose(state_, lane_, sums);
    if (without && open) {
      part(pull, sums);
    } else if (leaves(state_, lane_)) {
      hand_over(spring / (3 * lanes) * lanes + lane_, pull, sums);
    } else if (without && to_contact && is_gone(now_, std::sqrt(3 * batch_.area[lane_]))) {
      set_hand_over(state_, lane_, HandOver::leaving);
      sums.hands_over = true;
    }
    share(places_of(batch_, lane_), pull, force);
  }

private:
  // N, in space. What the point loses goes by the trapezoidal rule.
  Vec3 advance_point(int point, bool breaking, std::int64_t spring, FaceSums& sums, bool& open) {
    const double area = batch_.area[lane_];
    const Vec3 gap = now_.in_axes(now_.gap[point]), gap0 = before_.in_axes(before_.gap[point]);
    const Vec3 m = vec(face_.plane), offset = vec(face_.offset[point]);
    const PointResponse r = respond(law_, face_, point, gap, breaking);
    SofteningLoss lost; // nothing while it is whole
    if (r.law.damage > 0)
      lost = softening_loss(law_, m, gap0 + offset, face_.damage[point], vec(face_.slip[point]), gap + offset,
                            r.law);
    sums.friction += area * m[2] * lost.friction;
    const double grown = r.law.damage - face_.damage[point];
    const double begun_with =
        never_stored(law_, m, offset, face_.damage[point]) - never_stored(law_, m, offset, r.law.damage);
    const double taken = area * m[2] * (lost.breaking - begun_with);
    sums.breaking += taken + 0.5 * area * grown * vec(face_.rest[point]).dot(gap + gap0);
    if (grown > 0)
      sums.crack.add(std::max(0.0, taken), shear_share(law_, m, gap + offset));
    face_.damage[point] = r.law.damage;
    face_.slip[point] = array(r.law.slip);
    open = open && r.law.traction.isZero(0);
    std::uint8_t& mode = state_.mode[point][lane_];
    if (r.law.damage >= 1 && is_intact(mode)) {
      const BondMode how = r.law.mode == BondMode::intact ? BondMode::broken_tension : r.law.mode;
      mode = static_cast<std::uint8_t>(how);
      const Vec3 began = law_.kn * offset; // the relative displacement was nearly zero then
      sums.broken.push_back(
          {spring, how, now_.in_space(m), began.dot(m), (began - began.dot(m) * m).norm(), {}, {}});
    }
    return now_.in_space(area * r.traction);
  }

  double stored_at_point(int point) const { // J
    const Vec3 stretch = now_.in_axes(now_.gap[point]) + vec(face_.offset[point]);
    const SofteningResponse r = softening_response(law_, vec(face_.plane), stretch, face_.damage[point],
                                                   vec(face_.slip[point]), false);
    return batch_.area[lane_] * stored_at(law_, face_, point, stretch, r);
  }

  // What it still carries is let go of, less the half step of work that it would have done.
  void part(Vec3 (&pull)[3], FaceSums& sums) {
    for (int point = 0; point < 3; ++point) {
      sums.breaking += stored_at_point(point) - 0.5 * pull[point].dot(now_.gap[point] - before_.gap[point]);
      pull[point] = Vec3::Zero();
    }
    state_.stage[lane_] = FaceStage::parted;
  }

  void hand_over(std::int64_t face, const Vec3 (&pull)[3], FaceSums& sums) {
    sums.left.push_back({face, at_corners(pull), batch_.kn[lane_],
                         stored_at_point(0) + stored_at_point(1) + stored_at_point(2)});
    state_.stage[lane_] = FaceStage::parted;
    set_hand_over(state_, lane_, HandOver::done);
  }

  const FaceBatch& batch_;
  int lane_;
  FaceStateBatch& state_;
  CohesiveFace& face_;
  SofteningLaw law_;
  FaceFrame now_, before_;
};

void hold_resumed(const FaceBatch& batch, int lane, const FaceMotion& motion, const CohesiveFace& face,
                  Node* force) {
  const FaceFrame now = face_frame(batch, lane, motion, 0);
  Vec3 pull[3];
  for (int point = 0; point < 3; ++point)
    pull[point] = batch.kn[lane] * (now.gap[point] + now.in_space(vec(face.offset[point])));
  share(places_of(batch, lane), pull, force);
}

// The faces that have never cracked, eight side by side: they need no axes.
CDEM_INLINE void holding_kernel(const FaceBatch* batches, int faces, const Node* displacement,
                                const FaceStateBatch* state, Node* force) {
  using simd::Oct;
  using simd::Vec;
  for (int i = 0; i * lanes < faces; ++i) {
    const FaceBatch& batch = batches[i];
    Oct k = simd::load(batch.kn);
    bool any = false;
    for (int lane = 0; lane < lanes; ++lane) {
      const bool holds = i * lanes + lane < faces && state[i].stage[lane] == FaceStage::holding;
      k[lane] = holds ? k[lane] : 0;
      any = any || holds;
    }
    if (!any)
      continue;
    Vec d[3];
    for (int corner = 0; corner < 3; ++corner)
      d[corner] = simd::minus(simd::gather(displacement, batch.place_b[corner]),
                              simd::gather(displacement, batch.place_a[corner]));
    // The weights of points and corners, 1/6 + 1/2 where they are one, applied twice: 1/4 + 1/4 where they are one.
    const Vec sum = simd::plus(simd::plus(d[0], d[1]), d[2]);
    const Oct quarter = 0.25 * k;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec f = simd::scaled(quarter, simd::plus(sum, d[corner]));
      simd::scatter_add(force, batch.place_a[corner], f);
      simd::scatter_add(force, batch.place_b[corner], {-f.x, -f.y, -f.z});
    }
  }
}

void preload(const FaceBatch& batch, int lane, const FaceMotion& motion, const FaceLaw& law,
             FaceStateBatch& state, CohesiveFace& face, Node* force, FaceSums& sums) {
  bool remains = false;
  const double least = too_little * batch.area[lane] * std::max(law.tensile_strength, law.cohesion);
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3 q = vec(face.preload[corner]);
    if (q.isZero(0))
      continue;
    const int a = batch.place_a[corner][lane], b = batch.place_b[corner][lane];
    const Vec3 apart = vec(motion.displacement[b]) - vec(motion.displacement[a]);
    const double most = pushing * q.squaredNorm() / batch.kn[lane];
    const double remaining = q.dot(apart) < -most ? 0 : motion.step > 0 ? 1 - dying : 1;
    const Vec3 left = remaining * q;
    sums.breaking += 0.5 * motion.step * (q + left).dot(vec(motion.velocity[b]) - vec(motion.velocity[a]));
    face.preload[corner] = left.norm() > least ? array(left) : CohesiveFace::Vector{};
    remains = remains || left.norm() > least;
    add(force, a, left);
    add(force, b, -left);
  }
  state.preloaded[lane] = remains ? 1 : 0;
}

} // namespace

SofteningLaw cohesive_law(const Joint& joint, double k) {
  return softening_law(joint, geom::portable::tan(joint.friction_angle), k, k, SofteningBegins::at_strength);
}

double damage_of(const CohesiveFace& face) {
  return std::max({face.damage[0], face.damage[1], face.damage[2]});
}

void cohesive_face_forces(const FaceBatch* batches, int faces, const FaceMotion& motion, const FaceLaw& law,
                          const FaceJoints& joints, bool breaking, FaceStateBatch* state,
                          CohesiveFace* cohesive, Node* force, FaceSums& sums) {
  const bool to_contact = law.hands_over && law.hand_over_due;
  const ChunkLaw cracked{joints, law.tan_friction};
  simd::best<holding_kernel>(batches, faces, motion.displacement, state, force);
  for (int i = 0; i < faces; ++i) {
    const FaceBatch& batch = batches[i / lanes];
    FaceStateBatch& at = state[i / lanes];
    const int lane = i % lanes;
    if (at.stage[lane] == FaceStage::cracking)
      CrackingFace(batch, lane, motion, cracked.at(batch, i), at, cohesive[i])
          .advance(breaking, std::int64_t{i / lanes} * 3 * lanes + lane, to_contact, force, sums);
    else if (at.stage[lane] == FaceStage::resumed)
      hold_resumed(batch, lane, motion, cohesive[i], force);
    if (at.stage[lane] == FaceStage::parted) {
      if (to_contact && !handed_over(at, lane)) {
        set_hand_over(at, lane, HandOver::done);
        sums.hands_over = true;
      }
    } else if (at.preloaded[lane] != 0 && holds(at.stage[lane])) { // in a crack it would work without end
      preload(batch, lane, motion, law, at, cohesive[i], force, sums);
    }
  }
}

FaceSpring cohesive_spring(const FaceBatch& batch, int lane, const FaceFrame& f, int point,
                           const Joint& joint, const FaceStateBatch& state, const CohesiveFace& face) {
  FaceSpring spring;
  spring.gap = f.gap[point];
  spring.normal = f.normal;
  const Vec3 stretch = f.in_axes(f.gap[point]) + vec(face.offset[point]);
  if (holds(state.stage[lane])) {
    spring.force = batch.kn[lane] * f.in_space(stretch);
    spring.energy = 0.5 * batch.kn[lane] * stretch.squaredNorm();
  } else if (state.stage[lane] == FaceStage::cracking) {
    const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
    const PointResponse r = respond(law, face, point, f.in_axes(f.gap[point]), false);
    spring.force = f.in_space(batch.area[lane] * r.traction);
    spring.energy = batch.area[lane] * stored_at(law, face, point, stretch, r.law);
  }
  return spring;
}

namespace {

double stored(const FaceBatch& batch, int lane, const FaceFrame& f, const Joint& joint,
              const FaceStateBatch& state, const CohesiveFace& face) {
  double energy = 0;
  for (int point = 0; point < 3; ++point)
    energy += cohesive_spring(batch, lane, f, point, joint, state, face).energy;
  return energy;
}

} // namespace

double begin_crack(const FaceBatch& batch, int lane, const FaceMoment& at, const Joint& joint, const Vec3& m,
                   BondMode mode, FaceStateBatch& state, CohesiveFace& face) {
  const FaceFrame& f = at.frame;
  const double k = penalty(batch, lane), before = stored(batch, lane, f, joint, state, face);
  const geom::Mat3 stress = at.stress + at.relieved;
  const Vec3 on_plane = f.in_axes(stress * m), on_face = f.in_axes(stress * f.normal);
  state.stage[lane] = FaceStage::cracking;
  face.plane = array(f.in_axes(m));
  const SofteningLaw law = cohesive_law(joint, k);
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = f.in_axes(f.gap[point]), pulls = on_face + k * (gap + vec(face.offset[point]));
    face.offset[point] = array(on_plane / k - gap);
    face.rest[point] = {};
    // It may be damaged by a crack that ended.
    face.rest[point] =
        array((pulls - respond(law, face, point, gap, false).traction) / (1 - face.damage[point]));
    if (!law.softens())
      state.mode[point][lane] = static_cast<std::uint8_t>(mode);
  }
  double work = 0;
  for (const Vec3& moved : at.moved)
    work += 0.5 * batch.area[lane] * (at.relieved * f.normal).dot(moved);
  return before - stored(batch, lane, f, joint, state, face) - work;
}

double let_go(const FaceBatch& batch, int lane, const FaceMoment& at, const Joint& joint,
              FaceStateBatch& state, CohesiveFace& face) {
  const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
  const double before = stored(batch, lane, at.frame, joint, state, face);
  double work = 0;
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = at.frame.in_axes(at.frame.gap[point]);
    const Vec3 carried = respond(law, face, point, gap, false).traction;
    face.damage[point] = 1;
    face.rest[point] = {};
    const Vec3 lost = carried - respond(law, face, point, gap, false).traction;
    work += 0.5 * batch.area[lane] * at.frame.in_space(lost).dot(at.moved[point]);
  }
  return before - stored(batch, lane, at.frame, joint, state, face) + work;
}

bool may_end(const CohesiveFace& face) {
  return damage_of(face) <= hardly_damaged;
}

std::optional<double> end_crack(const FaceBatch& batch, int lane, const FaceMoment& at, const Joint& joint,
                                FaceStateBatch& state, CohesiveFace& face) {
  const FaceFrame& f = at.frame;
  const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
  const Vec3 m = vec(face.plane);
  for (int point = 0; point < 3; ++point) {
    const Vec3 t = law.kn * (f.in_axes(f.gap[point]) + vec(face.offset[point]));
    const double normal = t.dot(m), shear = (t - normal * m).norm(),
                 left = unloaded * (1 - face.damage[point]);
    if (normal > left * law.strength.tensile_strength ||
        cohesive_load(shear, law.strength.tan_friction, normal) > left * law.strength.cohesion)
      return std::nullopt;
  }
  const double before = stored(batch, lane, f, joint, state, face);
  const Vec3 on_face = f.in_axes(at.stress * f.normal);
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = f.in_axes(f.gap[point]);
    const Vec3 traction = respond(law, face, point, gap, false).traction;
    face.offset[point] = array((traction - on_face) / law.kn - gap);
    face.rest[point] = {};
  }
  state.stage[lane] = FaceStage::resumed;
  return before - stored(batch, lane, f, joint, state, face);
}

} // namespace cdem
