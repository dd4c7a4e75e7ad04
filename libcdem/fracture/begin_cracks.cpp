#include "libcdem/fracture/begin_cracks.hpp"

#include "libcdem/bond/cohesive_faces.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Steps between two looks at the same eight faces: a wave needs more to cross a freed tet.
constexpr std::int64_t look_every = 4;

// Eight faces side by side.
struct FaceStress {
  double component[6][lanes]; // Pa, in the order of Stress: the mean of both tets
  bool may_fail[lanes];
};

CDEM_INLINE void stress_kernel(const StressBatch* stress, const std::int32_t (&slot_a)[lanes],
                               const std::int32_t (&slot_b)[lanes], const double (&left)[lanes],
                               const std::vector<UseBound>& bounds, FaceStress& to) {
  using simd::Oct;
  Oct s[6];
  for (int c = 0; c < 6; ++c) {
    for (int lane = 0; lane < lanes; ++lane)
      s[c][lane] = stress[slot_a[lane] / lanes].component[c][slot_a[lane] % lanes] +
                   stress[slot_b[lane] / lanes].component[c][slot_b[lane] % lanes];
    s[c] *= 0.5;
    simd::store(to.component[c], s[c]);
  }
  const Oct part = simd::load(left);
  for (Oct& c : s)
    c /= part;
  for (bool& may_fail : to.may_fail)
    may_fail = false;
  for (const UseBound& bound : bounds) {
    const Oct beyond = bound.beyond(s);
    for (int lane = 0; lane < lanes; ++lane)
      to.may_fail[lane] = to.may_fail[lane] || beyond[lane] > 0;
  }
}

geom::Mat3 stress_in(const FaceStress& of, int lane) {
  Stress s{};
  for (int c = 0; c < 6; ++c)
    s[c] = of.component[c][lane];
  return matrix(s);
}

// 1/s, sqrt(d : d) of the rate of deformation d, in the mean of the two tets.
double strain_rate(const Model& model, const State& state, const FaceTets& tets) {
  double sum = 0;
  for (const int tet : {tets.tet_a, tets.tet_b}) {
    const geom::Mat3 f = geom::Mat3::Identity() + displacement_gradient(model, state.displacement, tet);
    const geom::Mat3 rate = displacement_gradient(model, state.velocity, tet) * f.inverse();
    sum += 0.5 * (rate + rate.transpose()).norm();
  }
  return 0.5 * sum;
}

class ChunkCracks {
public:
  ChunkCracks(const Model& model, State& state, std::int64_t index, double moved_for, bool in_real_time)
      : model_(model), state_(state), index_(index), moved_for_(moved_for), in_real_time_(in_real_time),
        chunk_(model.mesh.chunks[index]), body_(model.bodies[model.blocks[chunk_.block].body]),
        least_cosine_(body_.bonding.everywhere ? among_all_faces : among_a_border),
        joints_(model, state, chunk_), rocks_(body_) {
    if (!joints_.own())
      rocks_.take(-1, rock_strength(body_.joint));
    else
      for (int face = 0; face < chunk_.faces; ++face)
        rocks_.take(joints_.law(face), rock(face));
  }

  BegunCracks operator()() {
    const std::vector<UseBound> bounds = rocks_.bounds(1);
    for (int first = 0; first < chunk_.faces; first += lanes) {
      const std::int64_t batch = chunk_.face_batches.begin + first / lanes;
      const int faces = std::min(lanes, chunk_.faces - first);
      if ((state_.step + batch) % look_every != 0 || all_parted(batch, faces))
        continue;
      std::int32_t slot_a[lanes], slot_b[lanes];
      double left[lanes];
      for (int lane = 0; lane < lanes; ++lane) {
        const FaceTets& tets = model_.mesh.face_tets[batch * lanes + (lane < faces ? lane : 0)];
        slot_a[lane] = model_.mesh.tet_slot[tets.tet_a - model_.mesh.first_tet];
        slot_b[lane] = model_.mesh.tet_slot[tets.tet_b - model_.mesh.first_tet];
        left[lane] = lane < faces ? strength_left(batch, lane) : 1;
      }
      FaceStress stress;
      simd::best<stress_kernel>(state_.stress.data(), slot_a, slot_b, left, bounds, stress);
      for (int lane = 0; lane < faces; ++lane)
        one_face(batch, lane, stress);
    }
    if (breaking_ != 0)
      begun_.breaking.emplace_back(index_, breaking_);
    if (crack_.tension != 0 || crack_.shear != 0)
      begun_.energies.emplace_back(index_, crack_);
    return std::move(begun_);
  }

private:
  bool all_parted(std::int64_t batch, int faces) const {
    const auto& stage = state_.faces[batch].stage;
    return std::all_of(stage, stage + faces, [](FaceStage s) { return s == FaceStage::parted; });
  }

  // When the stress was computed.
  FaceFrame frame(std::int64_t batch, int lane) const {
    const auto since = [&](int node) { return geom::Vec3(moved_for_ * velocity_of(state_, node)); };
    return face_frame(
        face_nodes(model_.mesh, chunk_, batch, lane),
        [&](int node) { return geom::Vec3(place_of(model_, state_, node) - since(node)); },
        [&](int node) { return geom::Vec3(vec(state_.displacement[node]) - since(node)); });
  }

  void one_face(std::int64_t batch, int lane, const FaceStress& of_batch) {
    FaceStateBatch& face = state_.faces[batch];
    CohesiveFace& cohesive = state_.cohesive[batch * lanes + lane];
    const FaceBatch& at = model_.mesh.faces[batch];
    if (face.stage[lane] == FaceStage::cracking && may_end(cohesive))
      breaking_ += end_crack(at, lane, frame(batch, lane), joints_.of(place(batch, lane), room_),
                             stress_in(of_batch, lane), face, cohesive)
                       .value_or(0);
    else if (holds(face.stage[lane]) && of_batch.may_fail[lane])
      begin(batch, lane, stress_in(of_batch, lane), strength_left(batch, lane));
  }

  // Among the faces of the chunk.
  int place(std::int64_t batch, int lane) const {
    return static_cast<int>(batch - chunk_.face_batches.begin) * lanes + lane;
  }
  RockStrength rock(int face) const {
    return rocks_.of(joints_.law(face), joints_.tensile_strength(face), joints_.cohesion(face));
  }

  // Fraction of the strength: a crack that did not continue took the rest. At least the fraction that may_end leaves.
  double strength_left(std::int64_t batch, int lane) const {
    return state_.faces[batch].stage[lane] == FaceStage::resumed
               ? 1 - damage_of(state_.cohesive[batch * lanes + lane])
               : 1;
  }

  void begin(std::int64_t batch, int lane, const geom::Mat3& stress, double left) {
    const FaceFrame at = frame(batch, lane);
    const int face = place(batch, lane);
    auto plane = working_plane(stress / left, rock(face), at.normal, least_cosine_);
    if (plane && !state_.rate_factor.empty()) {
      const double factor =
          in_real_time_ ? dynamic_increase_factor(
                              joints_.before_rate(face).rate,
                              strain_rate(model_, state_, model_.mesh.face_tets[batch * lanes + lane]))
                        : 1;
      plane = working_plane(stress / (left * factor), rock(face), at.normal, least_cosine_);
      if (plane)
        state_.rate_factor[batch * lanes + lane] = factor;
    }
    if (!plane)
      return;
    const Joint& joint = joints_.of(face, room_);
    const double taken = begin_crack(model_.mesh.faces[batch], lane, at, joint, stress, plane->normal,
                                     plane->mode, state_.faces[batch], state_.cohesive[batch * lanes + lane]);
    breaking_ += taken;
    if (joint.softening != Softening::none)
      return;
    crack_.add(std::max(0.0, taken), plane->mode == BondMode::broken_shear ? 1 : 0);
    const geom::Vec3 traction = stress * plane->normal;
    const double normal = traction.dot(plane->normal);
    for (int point = 0; point < 3; ++point)
      begun_.broken.push_back({index_,
                               {batch, point, lane},
                               plane->mode,
                               plane->normal,
                               normal,
                               (traction - normal * plane->normal).norm()});
  }

  const Model& model_;
  State& state_;
  std::int64_t index_;
  double moved_for_; // s
  bool in_real_time_;
  const MeshChunk& chunk_;
  const Body& body_;
  double least_cosine_; // between a face and the plane that fails
  FaceJoints joints_;
  OwnRocks rocks_;
  Joint room_;
  BegunCracks begun_;
  double breaking_ = 0; // J, of the chunk
  CrackEnergy crack_;   // J, of the chunk
};

} // namespace

BegunCracks begin_cracks(const Model& model, State& state, Range chunks, double moved_for, int threads,
                         bool in_real_time) {
  std::vector<BegunCracks> of_chunks(static_cast<std::size_t>(chunks.size()));
  for_chunks(chunks, threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.side_batches.size() > 0 && !is_rigid(model, chunk))
      of_chunks[c - chunks.begin] = ChunkCracks(model, state, c, moved_for, in_real_time)();
  });
  BegunCracks all;
  for (const BegunCracks& some : of_chunks)
    append(some, all);
  return all;
}

void append(const BegunCracks& more, BegunCracks& all) {
  all.breaking.insert(all.breaking.end(), more.breaking.begin(), more.breaking.end());
  all.energies.insert(all.energies.end(), more.energies.begin(), more.energies.end());
  all.broken.insert(all.broken.end(), more.broken.begin(), more.broken.end());
}

} // namespace cdem
