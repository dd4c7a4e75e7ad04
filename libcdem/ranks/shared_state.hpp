// A State that several ranks advance together. In a step each rank computes its share of the chunks and receives from
// the others the data that its share reads. Between steps, when the State is read, all ranks have the whole State.
//
// A step sends (1) the forces of springs, to the ranks of the blocks on which they act; (2) the slices of partial
// forces, to the owners of nodes; (3) the new positions of nodes, to the ranks that read them; and sums. The owner
// alone moves a node, since it knows all forces on it. This needs one message more than if every rank with a copy moved
// the node, but half the rules.
#pragma once

#include "libcdem/ranks/links.hpp"
#include "libcdem/ranks/state_shares.hpp"

namespace cdem {

class SharedState {
public:
  // The state must be whole. read_always: nodes that this rank reads for any share of chunks. loads: chunk_loads.
  SharedState(const Model&, const std::vector<std::int32_t>& read_always, const std::vector<double>& loads);

  const Partition& part() const { return part_; }

  // In a step.
  void share_springs(std::vector<geom::Vec3>& spring_force, std::vector<geom::Vec3>& acting_force);
  void share_partial_forces(std::vector<geom::Vec3>& partial);
  void share_faces(State&); // that cracks have begun or ended in
  void share_nodes(State&); // moved, with the stress that faces of others read

  // Nodes that this rank reads beside those that the model tells of: those around its contacts. All ranks call it
  // together, where the state is whole.
  void set_further_nodes(std::vector<std::int32_t> nodes);

  // The state is not whole any more: each rank has its share and what it reads. Where nobody has looked at the whole for
  // some steps, the pages of others are given back: what is looked at often would only come and go.
  void parted(State&);
  bool whole() const { return whole_; }
  // What a search for contacts reads is: where nodes are, and which bonds hold.
  bool surfaces_whole() const { return whole_ || surfaces_whole_; }
  void gather_surfaces(State&);
  // Makes all of it whole.
  void gather(State&);
  const StateShares& shares() const { return *shares_; }
  // Copies the own share.
  void keep(State& state, State& copy) const;

private:
  Partition part_;
  std::shared_ptr<const StateShares> shares_;
  bool whole_ = true, surfaces_whole_ = true;
  std::int64_t since_whole_ = 0, since_surfaces_ = 0; // calls of `parted` since it was so
  std::vector<std::int32_t> nodes_;                   // that the model tells of, and read_always
  Links springs_, partial_, moved_, stress_, faces_;
};

} // namespace cdem
