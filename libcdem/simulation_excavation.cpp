// Rock taken out of the model, at once or by degrees.
#include "libcdem/load/excavation.hpp"
#include "libcdem/results/watch_carried.hpp"
#include "libcdem/simulation_impl.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/forces.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

// Smaller forces, over the largest, are rounding.
constexpr double least_part_of_force = 1e-9;

// What springs and contacts do where the nodes are now.
struct Forces {
  std::vector<Node> inner, contact;     // N (n_nodes); contact: empty without contacts
  std::vector<ContactOnRigid> on_rigid; // (n rigid bodies); empty without contacts
};

Forces forces_now(const Model& model, const State& state) {
  Workspace work(model, state, {});
  Forces forces;
  forces.inner = inner_forces(model, state, work, 1);
  forces.contact = work.contact.loads.force;
  forces.on_rigid = work.contact.loads.on_rigid;
  return forces;
}

// Nodes of springs between blocks that go and blocks that stay.
std::vector<char> nodes_beside_removed(const Model& model, const std::vector<int>& new_block) {
  std::vector<char> beside(model.node_position.size(), 0);
  for (const BondPoint& point : model.points) {
    const Interface& interface = model.interfaces[point.interface];
    if ((new_block[interface.block_a] < 0) != (new_block[interface.block_b] < 0))
      for (const auto* const side : {&point.node_a, &point.node_b})
        for (const int node : *side)
          beside[node] = 1;
  }
  return beside;
}

geom::Vec3 at(const std::vector<Node>& force, int node) {
  return force.empty() ? geom::Vec3(0, 0, 0) : vec(force[node]);
}

void require_no_rigid(const Forces& before, const Model& old, const Forces& after, const Rebuilt& rebuilt) {
  for (std::size_t r = 0; r < rebuilt.model.rigid.size(); ++r) {
    const int block = rebuilt.model.rigid[r].block;
    const auto was = static_cast<std::size_t>(old.blocks[rebuilt.old_block[block]].rigid);
    const geom::Vec3 force = before.on_rigid.empty() ? geom::Vec3(0, 0, 0) : before.on_rigid[was].force,
                     now = after.on_rigid.empty() ? geom::Vec3(0, 0, 0) : after.on_rigid[r].force;
    if ((force - now).norm() > least_part_of_force * std::max(force.norm(), now.norm()))
      throw geom::InputError(fmt::format(
          "remove: block {} of body \"{}\" is rigid and touches what is removed; forces of an "
          "excavation stay on bodies that deform only: make it deformable (model:make_deformable), "
          "or leave relaxed and over out",
          rebuilt.model.blocks[block].id, rebuilt.model.bodies[rebuilt.model.blocks[block].body].name));
  }
}

// N, of what is gone, at the nodes of what stays (n_nodes of the new model).
std::vector<Node> forces_of_removed(const Model& old, const State& from, const std::vector<int>& new_block,
                                    const Rebuilt& rebuilt) {
  const Forces before = forces_now(old, from), after = forces_now(rebuilt.model, rebuilt.state);
  require_no_rigid(before, old, after, rebuilt);
  const std::vector<char> beside = nodes_beside_removed(old, new_block);
  std::vector<Node> force(rebuilt.model.node_position.size());
  double largest = 0;
  for (std::size_t b = 0; b < rebuilt.model.blocks.size(); ++b) {
    const Block &now = rebuilt.model.blocks[b], &was = old.blocks[rebuilt.old_block[b]];
    for (int node = now.node_begin; node < now.node_end; ++node) {
      const int old_node = was.node_begin + (node - now.node_begin);
      geom::Vec3 gone = at(before.contact, old_node) - at(after.contact, node);
      if (beside[old_node] != 0)
        gone += vec(before.inner[old_node]) - vec(after.inner[node]);
      force[node] = cdem::node(gone);
      largest = std::max(largest, gone.norm());
    }
  }
  for (Node& f : force)
    if (vec(f).norm() <= least_part_of_force * largest)
      f = {};
  return force;
}

} // namespace

std::int64_t Simulation::remove(const Selection& on, const Excavation& excavation) {
  check(excavation);
  Impl& s = *impl_;
  std::vector<Successor> left;
  std::vector<int> new_block(s.model.blocks.size(), -1);
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b)
    if (!selects_block(s.model, on, b)) {
      new_block[b] = static_cast<int>(left.size());
      left.push_back(whole_block(s.model, b));
    }
  const auto removed = static_cast<std::int64_t>(s.model.blocks.size() - left.size());
  if (removed == 0)
    throw geom::InputError("on", on.text, "a place that holds block centroids",
                           "nothing of the model lies there, or a body of joined blocks or a mesh, whose one "
                           "centroid is elsewhere");
  if (left.empty())
    throw geom::InputError("on", on.text, "a part of the model",
                           "removing everything leaves nothing to solve");
  for (const Watch& watch : s.log.watches)
    for (const int unit : watch.blocks)
      if (new_block[unit] < 0)
        throw geom::InputError("on", on.text, "a place without units that are watched",
                               "block " + std::to_string(s.model.blocks[unit].id) + " of body \"" +
                                   s.model.bodies[s.model.blocks[unit].body].name + "\" is");
  Rebuilt rebuilt = rebuild(s.model, s.whole(), std::move(left), {}, MayBreak::all);
  if (excavation.relaxed < 1 || excavation.over > 0)
    keep_forces(forces_of_removed(s.model, s.whole(), new_block, rebuilt), excavation, rebuilt.state);
  for (Watch& watch : s.log.watches)
    carry_over(watch, new_block);
  s.adopt(std::move(rebuilt));
  s.warnings.of_lost_probes();
  return removed;
}

double Simulation::excavation_kept() const {
  const State& state = impl_->whole();
  double kept = 0;
  for (const ExcavationForce& force : state.excavation)
    kept = std::max(kept, force.share(state.time));
  return kept;
}

std::size_t Simulation::relax_excavation(const Excavation& excavation) {
  check(excavation);
  State& state = impl_->changing();
  const double kept = excavation_kept();
  const std::size_t count = relax_forces(excavation, state);
  if (kept > 0 && count == 0)
    throw geom::InputError("relaxed", fmt::format("{:g}", excavation.relaxed),
                           fmt::format("more than {:g}, which is relaxed already", 1 - kept));
  impl_->last_good = state;
  return count;
}

} // namespace cdem
