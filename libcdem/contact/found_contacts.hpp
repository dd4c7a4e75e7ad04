// Adds up what the rows have found in a step: the contacts that State has next, forces at nodes, resultants on rigid bodies,
// energies, depths. Serial, as it is little beside finding them.
//
// Energies and resultants are summed exactly by the rank that finds a contact, so that no order changes a bit. Forces at
// nodes are added in the order of contacts, by all ranks alike.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/narrow_phase/press_tets.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

class FoundContacts {
public:
  FoundContacts(const Model&, State&, ContactWork&);

  // Found by this rank: first all springs, then edges, in the order of their rows, then pairs of tetrahedra.
  void add(const ContactChunk&, Contact::Kind);
  // Found by all ranks alike.
  void add(std::vector<TetChunk>);

  // Tells the other ranks, and puts the contacts into State.
  ContactSums end();

private:
  void add(const Contact&, const ContactForce&, Contact::Kind);
  void add_at_nodes(const ContactForce&);
  void add_at_node(int node, int block, const geom::Vec3& force, double stiffness);
  void add_on_rigid(const ContactForce&);
  RigidSums& touched(int rigid);
  void find_ended();
  void add_losses();
  void remember_opened();
  void add_tets();
  void exchange();
  void set_values();

  const Model& model_;
  State& state_;
  ContactWork& work_;
  ContactSums sums_;
  ExactSum friction_, damping_; // J
  std::vector<TetChunk> tets_;
  std::vector<const Contact*> ended_; // in this step
  std::array<std::vector<ContactForce>, 2>
      told_; // to all ranks: of what deforms, per kind, in the order of rows
};

} // namespace cdem
