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

geom::Vec3 plane_in_space(const FaceFrame& frame, const CohesiveFace& face) {
  return frame.in_space({face.plane[0], face.plane[1], face.plane[2]});
}

// As that of joint/softening.hpp, where kn = ks.
double shear_share(const geom::Vec3& traction, const geom::Vec3& normal) {
  const double pull = traction.dot(normal);
  return pull > 0 ? 1 - pull * pull / traction.squaredNorm() : 1;
}

struct ChunkCracks : BegunCracks {
  CrackEnergy crack;
};

ChunkCracks of_chunk(const Model& model, State& state, std::int64_t index) {
  ChunkCracks begun;
  const MeshChunk& chunk = model.mesh.chunks[index];
  const Joint& joint = model.bodies[model.blocks[chunk.block].body].joint;
  const RockStrength rock = rock_strength(joint);
  const double least2 = rock.least_norm() * rock.least_norm();
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
      if (const auto taken = end_crack(at, lane, frame, joint, stress, cohesive)) {
        begun.breaking += *taken;
        begun.crack.add(
            *taken, shear_share(stress * plane_in_space(frame, cohesive), plane_in_space(frame, cohesive)));
      }
      continue;
    }
    const auto plane = working_plane(stress / left, rock, frame.normal);
    if (!plane)
      continue;
    const double taken =
        begin_crack(at, lane, frame, joint, stress, plane->normal, plane->mode, state.faces[batch], cohesive);
    const geom::Vec3 traction = stress * plane->normal;
    begun.breaking += taken;
    if (joint.softening != Softening::none) {
      begun.crack.add(taken, shear_share(traction, plane->normal));
      continue;
    }
    begun.crack.add(taken, plane->mode == BondMode::broken_shear ? 1 : 0);
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
  std::vector<ChunkCracks> of_chunks(model.mesh.chunks.size());
  for_chunks(static_cast<std::int64_t>(of_chunks.size()), threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.side_batches.size() > 0 && !is_rigid(model, chunk))
      of_chunks[c] = of_chunk(model, state, c);
  });
  BegunCracks all;
  for (std::size_t c = 0; c < of_chunks.size(); ++c) {
    const ChunkCracks& some = of_chunks[c];
    all.breaking += some.breaking;
    if (some.crack.tension != 0 || some.crack.shear != 0)
      all.energies.emplace_back(static_cast<std::int64_t>(c), some.crack);
    all.broken.insert(all.broken.end(), some.broken.begin(), some.broken.end());
  }
  return all;
}

} // namespace cdem
