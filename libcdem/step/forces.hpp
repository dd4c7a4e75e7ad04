// Net forces at nodes.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// Forces of the elements and springs of one chunk of star blocks, without loads, N, at its nodes; valid until the same
// thread's next chunk. Its nodes belong to no other chunk, so nothing is shared and there are no races. spring_forces
// has run before.
const Node* block_forces(const Model&, const State&, const Workspace&, std::int64_t chunk);

// N, of elements and springs at every node, where the nodes are now (n_nodes), without loads. The workspace gets the
// forces of contacts, where it does not have them (ContactWork::due).
std::vector<Node> inner_forces(const Model&, const State&, Workspace&, int threads,
                               const std::vector<char>& only = {}); // as below

// The same with loads and contacts, but for contacts of rigid bodies (ContactLoads::on_rigid); the workspace's loads are up
// to date. only: what other nodes get means nothing, where these are 1 (n_nodes).
std::vector<Node> net_forces(const Model&, const State&, Workspace&, int threads,
                             const std::vector<char>& only = {});

} // namespace cdem
