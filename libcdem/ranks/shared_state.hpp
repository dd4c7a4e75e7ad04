// A State that several ranks advance together. In a step each rank computes its share of the chunks and receives from
// the others the data that its share reads. Between steps, when the State is read, all ranks have the whole State.
//
// A step sends (1) the forces of springs, to the ranks of the blocks on which they act; (2) the slices of partial
// forces, to the owners of nodes; (3) the new positions of nodes, to the ranks that read them; and sums. The owner
// alone moves a node, since it knows all forces on it. This needs one message more than if every rank with a copy moved
// the node, but half the rules.
//
// The share of a process that is by itself is everything, and its calls that tell others do nothing.
#pragma once

#include "libcdem/ranks/links.hpp"
#include "libcdem/ranks/state_shares.hpp"

namespace cdem {

class SharedState {
public:
  explicit SharedState(const Model&); // of one that computes all
  // The state must be whole. read_always: nodes that this rank reads for any share of chunks. loads: chunk_loads.
  SharedState(const Model&, const std::vector<std::int32_t>& read_always, const std::vector<double>& loads);

  const Partition& part() const { return part_; }
  bool alone() const { return part_.size == 1; }

  // In a step.
  void share_springs(std::vector<geom::Vec3>& spring_force, std::vector<geom::Vec3>& acting_force);
  void share_partial_forces(std::vector<geom::Vec3>& partial);
  void share_faces(State&); // that cracks have begun or ended in
  void share_nodes(State&); // moved, with the stress that faces of others read

  // Nodes that this rank reads beside those that the model tells of: those around its contacts. All ranks call it
  // together, where the state is whole.
  void set_further_nodes(std::vector<std::int32_t> nodes);

  // Rigid bodies: one rank moves each and tells all how. Its nodes are placed by the ranks that own some of them or look at
  // its contacts.
  bool moves(int rigid) const { return mover_[rigid] == part_.rank; }
  const std::vector<int>& moved_bodies() const { return moved_bodies_; }
  const std::vector<int>& placed_bodies() const { return placed_bodies_; } // ascending
  void set_further_bodies(std::vector<int> rigid); // to place, beside those of which it owns nodes
  // angle: rad, per rigid body, by which each has turned in the step.
  void share_rigid(State&, std::vector<geom::Vec3>& angle);

  // The state is not whole any more: each rank has its share and what it reads. Where nobody has looked at the whole for
  // some steps, the pages of others are given back: what is looked at often would only come and go.
  void parted(State&);
  // What a search for contacts reads is: where nodes are, and which bonds hold.
  bool surfaces_whole() const { return whole_ || surfaces_whole_; }
  void gather_surfaces(State&);
  // This rank knows its own contacts of rigid bodies only, until they are gathered.
  void part_contacts(State&);
  bool contacts_whole() const { return contacts_whole_; }
  void gather_contacts(State&);
  // Makes all of it whole.
  void gather(State&);
  // Somebody may have done so by make_whole.
  void look_at(const State&);
  const StateShares& shares() const { return *shares_; }
  // Copies the own share.
  void keep(State& state, State& copy) const;

private:
  SharedState(const Model&, Partition);

  Partition part_;
  std::shared_ptr<const StateShares> shares_;
  bool whole_ = true, surfaces_whole_ = true, contacts_whole_ = true;
  std::int64_t since_whole_ = 0, since_surfaces_ = 0;          // calls of `parted` since it was so
  std::vector<std::int32_t> nodes_;                            // that the model tells of, and read_always
  std::vector<int> mover_;                                     // rank, per rigid body
  std::vector<int> moved_bodies_, own_bodies_, placed_bodies_; // rigid; own: of which it owns nodes
  Links springs_, partial_, moved_, stress_, faces_;
};

} // namespace cdem
