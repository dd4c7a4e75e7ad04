// Adds up what the rows have found in a step: the contacts that State has next, forces at nodes, resultants on rigid bodies,
// energies, depths. Serial, as it is little beside finding them.
//
// Energies and resultants are summed exactly by the rank that finds a contact, so that no order changes a bit. Forces at
// nodes are added in the order of contacts, by all ranks alike.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

class FoundContacts {
public:
  FoundContacts(const Model&, State&, ContactWork&);

  // Found by this rank: first all springs, then edges, in the order of their rows. Those of pairs of single tetrahedra
  // are known, and are added between them by the same order.
  void add(const ContactChunk&, Contact::Kind);

  // Tells the other ranks, and puts the contacts into State.
  ContactSums end();

private:
  void add(const Contact&, const ContactForce&, Contact::Kind);
  void add_of_tets_before(const Contact* next); // null: all
  void add_at_nodes(const ContactForce&);
  void add_on_rigid(const ContactForce&);
  RigidSums& touched(int rigid);
  void add_losses();
  void exchange();
  void set_values();

  const Model& model_;
  State& state_;
  ContactWork& work_;
  ContactSums sums_;
  ExactSum friction_, damping_;  // J
  std::size_t next_of_tets_ = 0; // into TetPairs::ordered
  std::array<std::vector<ContactForce>, 2>
      told_; // to all ranks: of what deforms, per kind, in the order of rows
};

} // namespace cdem
