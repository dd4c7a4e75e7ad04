#include "libcdem/step/support_forces.hpp"

#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/integrate/move_columns.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/forces.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem {

std::shared_ptr<SeenForces> nobody_looks() {
  return std::make_shared<SeenForces>();
}

SupportForces::SupportForces(const Model& model, const State& state, const Conditions& conditions,
                             int threads, const ContactLoads* contacts)
    : model_(model), work_(model, state, conditions, contacts), boundary_(state.support_force),
      state_(state) {
  find_side_forces(work_.resolved, state);
  update_external(work_.resolved, state.time, &state.velocity);
  net_ = net_forces(model, state, work_, threads);
  for (const std::size_t i : work_.resolved.boundary_loads) {
    const VaryingLoad& load = work_.resolved.varying[i];
    const double factor = load.amplitude(state.time);
    boundary_.resize(net_.size());
    for (const auto& [node, force] : load.forces)
      boundary_[node] = cdem::node(vec(boundary_[node]) + factor * force);
  }
}

geom::Vec3 SupportForces::reaction(const Selection& on) const {
  const std::vector<int> nodes = selected_nodes(model_, on);
  if (nodes.empty())
    throw geom::InputError("on", on.text, "a place that holds nodes", "nothing of the model lies there");
  geom::Vec3 sum = geom::Vec3::Zero();
  // A rigid body is held as a whole, by whichever of its nodes a support names: what acts on it counts once it is there.
  std::vector<char> counted(model_.rigid.size(), 0);
  for (const int node : nodes) {
    const int rigid = model_.blocks[block_of(model_, node)].rigid;
    if (rigid < 0 || counted[rigid] || !work_.resolved.rigid[rigid])
      continue;
    counted[rigid] = 1;
    const Block& block = model_.blocks[model_.rigid[rigid].block];
    for (int i = block.node_begin; i < block.node_end; ++i)
      sum -= vec(net_[i]);
    if (!work_.contact.loads.rigid_sums.empty()) // known to all ranks
      sum -= values(work_.contact.loads.rigid_sums[rigid].force);
  }
  for (const HeldNode& h : work_.resolved.held) {
    if (!std::binary_search(nodes.begin(), nodes.end(), h.node) ||
        model_.blocks[block_of(model_, h.node)].rigid >= 0)
      continue;
    const Node& f = net_[h.node];
    sum -= geom::Vec3((1 - h.free.x) * f.x, (1 - h.free.y) * f.y, (1 - h.free.z) * f.z);
    if (h.dashpot >= 0) {
      const geom::Vec3 pull = work_.resolved.dashpots[h.dashpot] * velocity_of(state_, h.node);
      sum -= vec(h.free).cwiseProduct(pull);
    }
  }
  if (!boundary_.empty())
    for (const int node : nodes)
      sum += vec(boundary_[node]);
  return sum;
}

geom::Vec3 reaction(const Model& model, const State& state, const Conditions& conditions, int threads,
                    SeenForces& seen, const Selection& on) {
  if (!seen.contacts)
    return SupportForces(model, state, conditions, threads).reaction(on);
  if (!seen.supports)
    seen.supports.emplace(model, state, conditions, threads, seen.contacts);
  return seen.supports->reaction(on);
}

geom::Vec3 momentum_of(const Model& model, const State& state, int body) {
  geom::Vec3 sum = geom::Vec3::Zero();
  for (const Block& block : model.blocks) {
    if (block.body != body)
      continue;
    if (block.rigid >= 0) {
      sum += model.rigid[block.rigid].mass * vec(state.rigid[block.rigid].velocity);
      continue;
    }
    for (int node = block.node_begin; node < block.node_end; ++node)
      sum += model.node_mass[node] * vec(state.velocity[node]);
  }
  return sum;
}

bool is_momentum(const Probe& probe) {
  return probe.crack.rfind("momentum", 0) == 0;
}

Selection place_of_support(const Model& model, const std::string& on) {
  for (const Body& body : model.bodies)
    if (body.name == on)
      return Selection::of_body(on);
  return Selection::side(on);
}

} // namespace cdem
