#include "libcdem/step/workspace.hpp"

#include "libcdem/contact/broad_phase/search.hpp"

#include <utility>

namespace cdem {
namespace {

ContactWork contact_work(const Model& model, const ContactLoads* loads) {
  ContactWork work;
  work.due = !loads;
  if (loads)
    work.loads = *loads;
  else
    start_contact(model, work);
  return work;
}

} // namespace

Workspace::Workspace(const Model& model, const State& state, const Conditions& conditions,
                     const ContactLoads* contacts)
    : Workspace(model, state, conditions, BondWork(model, state), contact_work(model, contacts)) {}

Workspace::Workspace(const Model& model, const State& state, const Conditions& conditions, BondWork bonds,
                     ContactWork contacts)
    : resolved(resolve(model, state, conditions)), bond(std::move(bonds)), contact(std::move(contacts)),
      node_sums(model.chunks.size()), rigid_sums(model.rigid.size()),
      rigid_angle(model.rigid.size(), geom::Vec3::Zero()) {
  if (!model.mesh.empty()) {
    partial.resize(static_cast<std::size_t>(model.mesh.chunks.back().partial.end));
    face_sums.resize(model.mesh.chunks.size());
    near.bits.assign(model.mesh.batches.size(), NearStrength::may_crack);
    near.forget_pulls(model);
    for (const MeshChunk& chunk : model.mesh.chunks)
      has_shared_nodes = has_shared_nodes || (!chunk.stars && chunk.inner_end < chunk.nodes.end);
  }
  share(std::make_shared<SharedState>(model));
}

} // namespace cdem
