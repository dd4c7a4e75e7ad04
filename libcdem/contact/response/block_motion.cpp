#include "libcdem/contact/response/block_motion.hpp"

#include "libcdem/contact/data/row_owner.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/ranks/bytes.hpp"
#include "libcdem/state/places.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cdem {

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

namespace {

std::uint64_t pair_of(int block_a, int block_b) {
  const auto [low, high] = std::minmax(block_a, block_b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
}

} // namespace

void sum_block_forces(const Model& model, const State& state, ContactWork& work) {
  work.block_forces.assign(model.blocks.size(), 0.0);
  work.block_stiffness.assign(model.blocks.size(), 0.0);
  work.pair_forces.clear();
  struct Sums {
    ExactSum force, stiffness;
  };
  std::vector<Sums> on_rigid(model.rigid.size());
  std::uint64_t last = 0; // no pair: its blocks differ
  PairForces* pair = nullptr;
  for (const Contact& c : state.contacts) {
    if (c.kind == Contact::tets) // within a block
      continue;
    const auto [a, b] = blocks_of(model, c);
    if (last != pair_of(a, b)) { // contacts of a pair stand side by side
      last = pair_of(a, b);
      pair = shares_friction(model, work, a, b) ? &work.pair_forces[last] : nullptr;
    }
    const double stiffness = c.effective_penetration() > 0 ? normal_stiffness_of(model, c) : 0,
                 force = stiffness * c.effective_penetration();
    if (stiffness > 0 && pair) {
      const double rests = part_at_rest(c);
      pair->felt += rests * c.felt_force;
      pair->usual += rests * c.usual_force;
    }
    for (const int block : {a, b})
      if (const int rigid = model.blocks[block].rigid; rigid < 0) {
        work.block_forces[block] += force;
        work.block_stiffness[block] += stiffness;
      } else if (keeps(model, work, c)) {
        on_rigid[rigid].force.add(force);
        on_rigid[rigid].stiffness.add(stiffness);
      }
  }
  if (!work.shared->alone() && !on_rigid.empty()) {
    Pack own;
    for (const Sums& sums : on_rigid)
      for (const ExactSum* sum : {&sums.force, &sums.stiffness})
        sum->tell(own);
    const std::vector<std::string> heard = ranks().gather(own.text(), Ranks::Subject::pressed);
    for (int rank = 0; rank < work.shared->part().size; ++rank) {
      Unpack unpack(heard[rank]);
      for (Sums& sums : on_rigid)
        if (rank != work.shared->part().rank)
          for (ExactSum* sum : {&sums.force, &sums.stiffness})
            sum->add_told(unpack);
    }
  }
  for (std::size_t i = 0; i < on_rigid.size(); ++i) {
    work.block_forces[model.rigid[i].block] = on_rigid[i].force.value();
    work.block_stiffness[model.rigid[i].block] = on_rigid[i].stiffness.value();
  }
}

double frequency_on_contacts(const Model& model, const ContactWork& work, int block_a, int block_b) {
  double sum = 0; // 1/s2
  for (const int block : {block_a, block_b})
    if (work.travel.last_displacement[block] != 0) { // else it is held
      const Block& b = model.blocks[block];
      sum += work.block_stiffness[block] / (b.mass.volume * model.bodies[b.body].material.density);
    }
  return std::sqrt(sum);
}

bool shares_friction(const Model& model, const ContactWork& work, int block_a, int block_b) {
  return (model.blocks[block_a].rigid < 0 || model.blocks[block_b].rigid < 0) &&
         !work.fragments.broken[block_a] && !work.fragments.broken[block_b];
}

double felt_over_usual(const ContactWork& work, int block_a, int block_b) {
  const auto pair = work.pair_forces.find(pair_of(block_a, block_b));
  return pair != work.pair_forces.end() && pair->second.usual > 0 ? pair->second.felt / pair->second.usual
                                                                  : 1;
}

bool is_in_one_piece(const Model& model, const ContactWork& work, int block) {
  return model.blocks[block].meshed && !work.fragments.broken[block];
}

void find_block_motions(const Model& model, const State& state, ContactWork& work, int threads) {
  work.block_motion.assign(model.blocks.size(), {});
  for_chunks(static_cast<std::int64_t>(model.blocks.size()), threads, [&](std::int64_t b) {
    if (is_in_one_piece(model, work, static_cast<int>(b)) && work.block_forces[b] > 0)
      work.block_motion[b] = motion_of(model, state, model.blocks[b]);
  });
}

} // namespace cdem
