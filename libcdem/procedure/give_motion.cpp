#include "libcdem/procedure/give_motion.hpp"

#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/error.hpp"

namespace cdem {
namespace {

void require_whole_rigid_bodies(const Model& model, const std::vector<int>& selected, const std::string& on) {
  for (const RigidBody& body : model.rigid) {
    const Block& block = model.blocks[body.block];
    if (selected[body.block] != 0 && selected[body.block] != block.node_end - block.node_begin)
      throw geom::InputError("on", on, "whole rigid bodies",
                             "a part of block " + std::to_string(block.id) + " has no velocity of its own");
  }
}

} // namespace

geom::Vec3 centroid_of(const Model& model, const State& state, const std::vector<int>& nodes) {
  const geom::Vec3 origin =
      place_of(model, state, nodes.front()); // near, so that the sums have the body's size
  geom::Vec3 moment = geom::Vec3::Zero();
  double mass = 0;
  for (const int i : nodes) {
    moment += model.node_mass[i] * (place_of(model, state, i) - origin);
    mass += model.node_mass[i];
  }
  return origin + moment / mass;
}

bool fixes_stop(const std::vector<Fix>& fixes, const Model& model, const State& state,
                const std::vector<int>& nodes, const RigidMotion& given) {
  Conditions supports;
  supports.fixes = fixes;
  const ResolvedConditions resolved = resolve(model, state, supports);
  std::vector<geom::Vec3> free(model.node_position.size(), geom::Vec3::Ones());
  for (const HeldNode& h : resolved.held)
    free[h.node] = vec(h.free);
  bool moves = false;
  for (const int i : nodes) {
    const geom::Vec3 velocity =
        given.velocity + given.angular_velocity.cross(place_of(model, state, i) - given.about);
    moves = moves || !velocity.isZero(0);
    if (!velocity.cwiseProduct(free[i]).isZero(0))
      return false;
  }
  return moves;
}

double give_motion(const Model& model, State& state, const std::vector<int>& nodes, const RigidMotion& given,
                   const std::string& on) {
  std::vector<int> selected(model.blocks.size(), 0);
  for (const int i : nodes)
    ++selected[block_of(model, i)];
  require_whole_rigid_bodies(model, selected, on);
  const geom::Vec3& w = given.angular_velocity;
  const geom::Mat3 back = turn(-state.velocity_lag * w);
  const auto velocity_at = [&](const geom::Vec3& x) -> geom::Vec3 {
    return given.velocity + w.cross(back * (x - given.about));
  };
  double gained = 0;
  for (const RigidBody& body : model.rigid)
    if (selected[body.block] != 0) {
      RigidState& motion = state.rigid[model.blocks[body.block].rigid];
      gained -= kinetic_energy(body, motion, state.velocity_lag);
      const geom::Mat3 axes = back * rotation(motion);
      motion.velocity = three_of(velocity_at(vec(motion.centroid)));
      motion.angular_momentum = three_of(axes * (body.inertia * (axes.transpose() * w)));
      gained += kinetic_energy(body, motion, state.velocity_lag);
    }
  for (const int i : nodes) {
    const double before = vec(state.velocity[i]).squaredNorm();
    const geom::Vec3 velocity = velocity_at(place_of(model, state, i));
    state.velocity[i] = node(velocity);
    if (model.blocks[block_of(model, i)].rigid < 0)
      gained += 0.5 * model.node_mass[i] * (velocity.squaredNorm() - before);
  }
  return gained;
}

} // namespace cdem
