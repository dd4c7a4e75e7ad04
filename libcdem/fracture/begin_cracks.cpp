#include "libcdem/fracture/begin_cracks.hpp"

#include "libcdem/bond/cohesive_faces.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/working_plane.hpp"
#include "libcdem/state/places.hpp"

#include <cmath>

namespace cdem {
namespace {

FaceFrame frame_of(const Model& model, const State& state, const FaceNodes& nodes) {
  return face_frame(
      nodes, [&](int node) { return place_of(model, state, node); },
      [&](int node) { return vec(state.displacement[node]); });
}

// What the faces of a chunk bear.
class Rocks {
public:
  Rocks(const Body& body, const FaceJoints& joints, int faces) : joints_(joints) {
    for (int law = -1; law < static_cast<int>(body.region_laws.joints.size()); ++law)
      of_law_.push_back(rock_strength(body.joint_of(law)));
    least_ = of_law_[0].least_norm();
    if (joints.own())
      for (int face = 0; face < faces; ++face)
        least_ = std::min(least_, of(face).least_norm());
  }
  RockStrength of(int face) const {
    RockStrength rock = of_law_[static_cast<std::size_t>(joints_.law(face) + 1)];
    rock.tensile_strength = joints_.tensile_strength(face);
    rock.cohesion = joints_.cohesion(face);
    return rock;
  }
  double least_norm() const { return least_; } // Pa

private:
  const FaceJoints& joints_;
  std::vector<RockStrength> of_law_; // that of the body first
  double least_ = 0;
};

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

BegunCracks of_chunk(const Model& model, State& state, std::int64_t index) {
  BegunCracks begun;
  const MeshChunk& chunk = model.mesh.chunks[index];
  const FaceJoints joints(model, state, chunk);
  const Rocks rocks(model.bodies[model.blocks[chunk.block].body], joints, chunk.faces);
  const double least2 = rocks.least_norm() * rocks.least_norm();
  Joint room;
  for (int i = 0; i < chunk.faces; ++i) {
    const std::int64_t face = chunk.face_batches.begin * lanes + i, batch = face / lanes;
    const int lane = static_cast<int>(face % lanes);
    CohesiveFace& cohesive = state.cohesive[face];
    const bool cracks = cohesive.at() == FaceStage::cracking;
    const double left = 1 - damage_of(cohesive); // of its strength
    if (cohesive.at() == FaceStage::parted || left <= 0)
      continue;
    const FaceTets& tets = model.mesh.face_tets[face];
    const geom::Mat3 stress =
        0.5 * (matrix(mesh_stress(model, state, tets.tet_a)) + matrix(mesh_stress(model, state, tets.tet_b)));
    if (!cracks && stress.squaredNorm() < least2 * left * left)
      continue;
    const FaceBatch& at = model.mesh.faces[batch];
    const FaceFrame frame = frame_of(model, state, face_nodes(model.mesh, chunk, batch, lane));
    if (cracks) {
      begun.breaking += end_crack(at, lane, frame, joints.of(i, room), stress, cohesive).value_or(0);
      continue;
    }
    RockStrength rock = rocks.of(i);
    auto plane = working_plane(stress / left, rock, frame.normal);
    if (!plane)
      continue;
    if (!state.rate_factor.empty()) {
      const double factor =
          dynamic_increase_factor(joints.before_rate(i).rate, strain_rate(model, state, tets));
      rock.tensile_strength *= factor;
      rock.cohesion *= factor;
      plane = working_plane(stress / left, rock, frame.normal);
      if (!plane)
        continue;
      state.rate_factor[face] = factor;
    }
    const Joint& joint = joints.of(i, room);
    begun.breaking +=
        begin_crack(at, lane, frame, joint, stress, plane->normal, plane->mode, state.faces[batch], cohesive);
    if (joint.softening != Softening::none)
      continue;
    const geom::Vec3 traction = stress * plane->normal;
    const double normal = traction.dot(plane->normal);
    for (int point = 0; point < 3; ++point)
      begun.broken.push_back({index,
                              {batch, point, lane},
                              plane->mode,
                              plane->normal,
                              normal,
                              (traction - normal * plane->normal).norm()});
  }
  return begun;
}

} // namespace

BegunCracks begin_cracks(const Model& model, State& state, int threads) {
  std::vector<BegunCracks> of_chunks(model.mesh.chunks.size());
  for_chunks(static_cast<std::int64_t>(of_chunks.size()), threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.side_batches.size() > 0 && !is_rigid(model, chunk))
      of_chunks[c] = of_chunk(model, state, c);
  });
  BegunCracks all;
  for (const BegunCracks& some : of_chunks) {
    all.breaking += some.breaking;
    all.broken.insert(all.broken.end(), some.broken.begin(), some.broken.end());
  }
  return all;
}

} // namespace cdem
