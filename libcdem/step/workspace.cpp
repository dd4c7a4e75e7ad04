#include "libcdem/step/workspace.hpp"

#include "libcdem/contact/broad_phase/search.hpp"

namespace cdem {

Workspace::Workspace(const Model& model, const State& state, const Conditions& conditions,
                     const ContactLoads* contacts)
    : resolved(resolve(model, state, conditions)), bond(model, state), node_sums(model.chunks.size()),
      rigid_sums(model.rigid.size()), rigid_angle(model.rigid.size(), geom::Vec3::Zero()) {
  if (!model.mesh.empty()) {
    partial.resize(static_cast<std::size_t>(model.mesh.chunks.back().partial.end));
    face_sums.resize(model.mesh.chunks.size());
    near.bits.assign(model.mesh.batches.size(), NearStrength::may_crack);
    for (const MeshChunk& chunk : model.mesh.chunks)
      has_shared_nodes = has_shared_nodes || (!chunk.stars && chunk.inner_end < chunk.nodes.end);
  }
  contact.due = !contacts;
  if (contacts)
    contact.loads = *contacts;
  else
    start_contact(model, contact);
  share(std::make_shared<SharedState>(model));
}

} // namespace cdem
