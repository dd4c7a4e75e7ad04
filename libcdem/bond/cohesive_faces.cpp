#include "libcdem/bond/cohesive_faces.hpp"

#include "libcdem/bond/cracking_faces.hpp"
#include "libcdem/bond/end_of_face.hpp"
#include "libcdem/parallel/simd.hpp"

#include <algorithm>

namespace cdem {
namespace {

using geom::Vec3;

// Part of a preload that dies in a step, and what of a face's strength is too little to keep.
constexpr double dying = 1.0 / 200, too_little = 1e-6;
// Work that a preload q may do on its face's sides before it ends, over q^2 / (k A).
constexpr double pushing = 0.01;
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
    Eigen::Map<Vec3> q(face.preload[corner].data());
    if (q.isZero(0))
      continue;
    const int a = batch.place_a[corner][lane], b = batch.place_b[corner][lane];
    const Vec3 apart = vec(motion.displacement[b]) - vec(motion.displacement[a]);
    const double most = pushing * q.squaredNorm() / batch.kn[lane];
    const double remaining = q.dot(apart) < -most ? 0 : motion.step > 0 ? 1 - dying : 1;
    const Vec3 left = remaining * q;
    sums.breaking += 0.5 * motion.step * (q + left).dot(vec(motion.velocity[b]) - vec(motion.velocity[a]));
    q = left.norm() > least ? left : Vec3(Vec3::Zero());
    remains = remains || left.norm() > least;
    add(force, a, left);
    add(force, b, -left);
  }
  state.preloaded[lane] = remains ? 1 : 0;
}

} // namespace

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
  const CohesiveChunk chunk{batches, motion, joints, law, breaking, state, cohesive, force, sums, pull2};
  advance_cracking(chunk, cracking.data(), static_cast<int>(cracking.size()));
  hold_resumed(chunk, resumed.data(), static_cast<int>(resumed.size()));
  for (const int i : others) {
    FaceStateBatch& at = state[i / lanes];
    const int lane = i % lanes;
    if (holds(at.stage[lane])) { // a preload would work without end in a crack
      preload(batches[i / lanes], lane, motion, law, at, cohesive[i], force, sums);
    } else if (law.hands_over && law.hand_over_due && !handed_over(at, lane)) {
      hand_over(lane, at, sums);
    }
  }
  if (law.hands_over && law.hand_over_due)
    take_back(batches, faces, motion, state, sums,
              [&](int face, const FaceFrame&) { EndOfFace(chunk, face).come_back(); });
}

} // namespace cdem
