#include "libcdem/bond/cohesive_faces.hpp"

#include "libcdem/bond/cohesive_law.hpp"
#include "libcdem/bond/cracking_faces.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace cdem {
namespace {

using geom::Vec3;

// Part of a preload that dies in a step, and what of a face's strength is too little to keep.
constexpr double dying = 1.0 / 200, too_little = 1e-6;
// Work that a preload q may do on its face's sides before it ends, over q^2 / (k A).
constexpr double pushing = 0.01;
// A crack ends where less than this part of its strength is asked of it.
constexpr double unloaded = 0.97;

Vec3 vec(const CohesiveFace::Vector& v) {
  return {v[0], v[1], v[2]};
}
CohesiveFace::Vector array(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

double penalty(const FaceBatch& batch, int lane) { // k, Pa/m
  return batch.kn[lane] / batch.area[lane];
}

void add(Node* force, int place, const Vec3& f) {
  force[place].x += f.x();
  force[place].y += f.y();
  force[place].z += f.z();
}

// The faces that have never cracked, eight side by side: they need no axes.
CDEM_INLINE void holding_kernel(const FaceBatch* batches, int faces, const Node* displacement,
                                const FaceStateBatch* state, Node* force, double* pull2) {
  using simd::Oct;
  using simd::Vec;
  for (int i = 0; i * lanes < faces; ++i) {
    const FaceBatch& batch = batches[i];
    Oct k = simd::load(batch.kn);
    const auto holds = simd::lanes_with<Oct>(reinterpret_cast<const std::uint8_t*>(state[i].stage),
                                             static_cast<std::uint8_t>(FaceStage::holding));
    k = holds ? k : Oct{};
    if (!simd::any(holds)) {
      simd::store_wide<Oct>(pull2 + i * lanes, Oct{});
      continue;
    }
    Vec d[3];
    for (int corner = 0; corner < 3; ++corner)
      d[corner] = simd::minus(simd::gather(displacement, batch.place_b[corner]),
                              simd::gather(displacement, batch.place_a[corner]));
    // The weights of points and corners, 1/6 + 1/2 where they are one, applied twice: 1/4 + 1/4 where they are one.
    const Vec sum = simd::plus(simd::plus(d[0], d[1]), d[2]);
    const Oct quarter = 0.25 * k, mean = k / (3.0 * simd::load(batch.area));
    simd::store_wide<Oct>(pull2 + i * lanes,
                          Oct(mean * mean * (sum.x * sum.x + sum.y * sum.y + sum.z * sum.z)));
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
  const double stiffness = crack_stiffness * k;
  return softening_law(joint, stiffness, stiffness, SofteningBegins::at_strength);
}

void cohesive_face_forces(const FaceBatch* batches, int faces, const FaceMotion& motion, const FaceLaw& law,
                          const FaceJoints& joints, bool breaking, FaceStateBatch* state,
                          CohesiveFace* cohesive, Node* force, FaceSums& sums, double* pull2) {
  simd::best<holding_kernel>(batches, faces, motion.displacement, state, force, pull2);
  thread_local std::vector<int> cracking, resumed, others;
  for (std::vector<int>* list : {&cracking, &resumed, &others})
    list->clear();
  for (int first = 0; first < faces; first += lanes) {
    const FaceStateBatch& at = state[first / lanes];
    const unsigned used = (1u << std::min(faces - first, lanes)) - 1,
                   resume = faces_in(at, FaceStage::resumed),
                   hold = faces_in(at, FaceStage::holding) | resume,
                   crack = faces_in(at, FaceStage::cracking) | faces_in(at, FaceStage::separated),
                   parted = faces_in(at, FaceStage::parted),
                   preloaded = ~simd::bits_with(at.preloaded, 0) & hold;
    const auto add = [&](unsigned bits, std::vector<int>& list) {
      each_lane(bits & used, [&](int lane) { list.push_back(first + lane); });
    };
    add(crack, cracking);
    add(resume, resumed);
    add(parted | preloaded, others);
  }
  const CohesiveChunk chunk{
      batches, motion, joints, law.tan_friction, breaking, law.hands_over, law.hand_over_due, state, cohesive,
      force,   sums,   pull2};
  advance_cracking(chunk, cracking.data(), static_cast<int>(cracking.size()));
  hold_resumed(chunk, resumed.data(), static_cast<int>(resumed.size()));
  for (const int i : others) {
    FaceStateBatch& at = state[i / lanes];
    const int lane = i % lanes;
    if (holds(at.stage[lane])) { // a preload would work without end in a crack
      preload(batches[i / lanes], lane, motion, law, at, cohesive[i], force, sums);
    } else if (law.hands_over && law.hand_over_due && !handed_over(at, lane)) {
      set_hand_over(at, lane, HandOver::done);
      sums.hands_over = true;
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
  } else if (has_springs(state.stage[lane])) {
    const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
    const CohesivePoint<double> at = cohesive_point(face, point);
    const Triple<double> gap = triple(f.in_axes(f.gap[point]));
    const CohesiveResponse<double> r = cohesive_response<double>(law, at, gap, false);
    const double area = (1 - state.let_go[lane]) * batch.area[lane];
    spring.force = f.in_space(area * vec(r.traction));
    spring.energy = area * cohesive_stored<double>(law, at, gap, r);
  }
  return spring;
}

namespace {

// Pa, what a cracking point carries, in the face's axes.
Vec3 carried(const SofteningLaw& law, const CohesiveFace& face, int point, const Vec3& gap) {
  return vec(cohesive_response<double>(law, cohesive_point(face, point), triple(gap), false).traction);
}

double stored(const FaceBatch& batch, int lane, const FaceFrame& f, const Joint& joint,
              const FaceStateBatch& state, const CohesiveFace& face) {
  double energy = 0;
  for (int point = 0; point < 3; ++point)
    energy += cohesive_spring(batch, lane, f, point, joint, state, face).energy;
  return energy;
}

} // namespace

std::array<Vec3, 3> carried_tractions(const FaceBatch& batch, int lane, const FaceFrame& f,
                                      const geom::Mat3& stress, const Joint& joint, FaceStage stage,
                                      const CohesiveFace& face) {
  const double k = penalty(batch, lane);
  const Vec3 on_face = stress * f.normal;
  std::array<Vec3, 3> tractions;
  for (int point = 0; point < 3; ++point)
    tractions[point] =
        holds(stage) ? Vec3(on_face + k * (f.gap[point] + f.in_space(vec(face.offset[point]))))
                     : f.in_space(carried(cohesive_law(joint, k), face, point, f.in_axes(f.gap[point])));
  return tractions;
}

Vec3 mean_traction(const FaceBatch& batch, int lane, const FaceFrame& f, const Joint& joint,
                   const FaceStateBatch& state, const CohesiveFace& face) {
  Vec3 force = Vec3::Zero();
  for (int point = 0; point < 3; ++point)
    force += cohesive_spring(batch, lane, f, point, joint, state, face).force;
  return force / (3 * batch.area[lane]);
}

double begin_crack(const FaceBatch& batch, int lane, const FaceMoment& at, const Joint& joint, const Vec3& m,
                   BondMode mode, FaceStateBatch& state, CohesiveFace& face) {
  const FaceFrame& f = at.frame;
  const double k = penalty(batch, lane), before = stored(batch, lane, f, joint, state, face);
  const geom::Mat3 stress = at.stress + at.relieved;
  const Vec3 on_plane = f.in_axes((at.borne + at.relieved) * m), on_face = f.in_axes(stress * f.normal);
  state.stage[lane] = FaceStage::cracking;
  face.plane = array(f.in_axes(m));
  const SofteningLaw law = cohesive_law(joint, k);
  double work = 0;
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = f.in_axes(f.gap[point]), held = on_face + k * (gap + vec(face.offset[point])),
               pulls = at.carried ? f.in_axes((*at.carried)[point]) : held;
    const PartsOfStretch<double> stands = parts_of_stretch<double>(
        law, triple(f.in_axes(m)), triple(Vec3((at.carried ? pulls : on_plane) / law.kn)));
    work += 0.5 * batch.area[lane] * (at.relieved * f.normal + f.in_space(pulls - held)).dot(at.moved[point]);
    // A crack that ended may have damaged it: its law goes on where it was.
    const double part = 1 - face.damage[point];
    double drawn = fourth_power(part);
    Vec3 bonded = vec(stands.bonded) / (part * drawn);
    // What pressure stores in the contact of a brittle face, its own springs may have stored. r0 bears the rest for a step.
    if (at.carried && !law.softens) {
      const double own = k * (gap + vec(face.offset[point])).squaredNorm(),
                   contact = law.kn * vec(stands.pressed).squaredNorm();
      drawn = contact > own ? 1 - own / contact : 0;
      bonded.setZero();
    }
    face.offset[point] = array(vec(stands.pressed) + bonded);
    face.start[point] = array(gap);
    face.drawn[point] = drawn;
    face.slip[point] = {};
    face.rest[point] = {};
    face.rest[point] = array((pulls - carried(law, face, point, gap)) / part);
    if (!law.softens)
      state.mode[point][lane] = static_cast<std::uint8_t>(mode);
  }
  return before - stored(batch, lane, f, joint, state, face) - work;
}

void break_face(const Model& model, State& of_all, const MeshChunk& chunk, std::int64_t number, int lane,
                const geom::Mat3& stress) {
  const FaceBatch& batch = model.mesh.faces[number];
  FaceStateBatch& state = of_all.faces[number];
  CohesiveFace& face = of_all.cohesive[number * lanes + lane];
  const FaceFrame f = face_frame(
      face_nodes(model.mesh, chunk, number, lane), [&](int node) { return place_of(model, of_all, node); },
      [&](int node) { return cdem::vec(of_all.displacement[node]); });
  Joint room;
  const Joint& joint =
      FaceJoints(model, of_all, chunk).of((number - chunk.face_batches.begin) * lanes + lane, room);
  const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
  CohesiveFace broken;
  broken.plane[2] = 1;
  broken.damage = {1, 1, 1};
  for (int point = 0; point < 3; ++point) {
    const Vec3 traction = stress * f.normal +
                          cohesive_spring(batch, lane, f, point, joint, state, face).force / batch.area[lane];
    const Vec3 stretch = f.in_axes(traction) / law.kn;
    broken.offset[point] = array(vec(parts_of_stretch<double>(law, {0, 0, 1}, triple(stretch)).pressed));
    broken.start[point] = array(f.in_axes(f.gap[point]));
    state.mode[point][lane] = static_cast<std::uint8_t>(BondMode::contact);
  }
  face = broken;
  state.stage[lane] = FaceStage::cracking;
  state.preloaded[lane] = 0;
}

double let_go(const FaceBatch& batch, int lane, const FaceMoment& at, const Joint& joint,
              FaceStateBatch& state, CohesiveFace& face) {
  const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
  const double before = stored(batch, lane, at.frame, joint, state, face);
  double work = 0;
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = at.frame.in_axes(at.frame.gap[point]);
    const Vec3 before_it = carried(law, face, point, gap);
    face.damage[point] = 1;
    face.rest[point] = {};
    const Vec3 lost = before_it - carried(law, face, point, gap);
    work += 0.5 * batch.area[lane] * at.frame.in_space(lost).dot(at.moved[point]);
  }
  return before - stored(batch, lane, at.frame, joint, state, face) + work;
}

std::optional<double> end_crack(const FaceBatch& batch, int lane, const FaceMoment& at, const Joint& joint,
                                FaceStateBatch& state, CohesiveFace& face) {
  const FaceFrame& f = at.frame;
  const SofteningLaw law = cohesive_law(joint, penalty(batch, lane));
  const Vec3 m = vec(face.plane);
  for (int point = 0; point < 3; ++point) {
    const CohesiveResponse<double> r =
        cohesive_response<double>(law, cohesive_point(face, point), triple(f.in_axes(f.gap[point])), false);
    const Vec3 t = vec(r.across);
    const double normal = t.dot(m), shear = (t - normal * m).norm(),
                 left = unloaded * (1 - face.damage[point]);
    if (normal > left * law.tensile_strength ||
        cohesive_load(shear, law.tan_friction, normal) > left * law.cohesion)
      return std::nullopt;
  }
  const double before = stored(batch, lane, f, joint, state, face);
  const Vec3 on_face = f.in_axes(at.stress * f.normal);
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = f.in_axes(f.gap[point]);
    const Vec3 traction = carried(law, face, point, gap);
    face.offset[point] = array((traction - on_face) / penalty(batch, lane) - gap);
    face.rest[point] = {};
  }
  state.stage[lane] = FaceStage::resumed;
  return before - stored(batch, lane, f, joint, state, face);
}

} // namespace cdem
