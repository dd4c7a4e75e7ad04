#include "libcdem/contact/response/block_motion.hpp"

#include "libcdem/state/places.hpp"

#include <Eigen/LU>

namespace cdem {
namespace {

BlockMotion motion_of(const Model& model, const State& state, const Block& block) {
  BlockMotion motion;
  double mass = 0;
  for (int i = block.node_begin; i < block.node_end; ++i) {
    mass += model.node_mass[i];
    motion.centroid += model.node_mass[i] * place_of(model, state, i);
    motion.velocity += model.node_mass[i] * velocity_of(state, i);
  }
  motion.centroid /= mass;
  motion.velocity /= mass;
  geom::Mat3 inertia = geom::Mat3::Zero();
  geom::Vec3 angular = geom::Vec3::Zero();
  for (int i = block.node_begin; i < block.node_end; ++i) {
    const geom::Vec3 arm = place_of(model, state, i) - motion.centroid;
    inertia += model.node_mass[i] * (arm.squaredNorm() * geom::Mat3::Identity() - arm * arm.transpose());
    angular += model.node_mass[i] * arm.cross(velocity_of(state, i) - motion.velocity);
  }
  motion.spin = inertia.inverse() * angular;
  motion.whole = motion.spin.allFinite();
  return motion;
}

} // namespace

void find_block_motions(const Model& model, const State& state, ContactWork& work, int threads) {
  work.block_motion.assign(model.blocks.size(), {});
  for_chunks(static_cast<std::int64_t>(model.blocks.size()), threads, [&](std::int64_t b) {
    if (model.blocks[b].meshed && !work.broken[b] && work.block_forces[b] > 0)
      work.block_motion[b] = motion_of(model, state, model.blocks[b]);
  });
}

} // namespace cdem
