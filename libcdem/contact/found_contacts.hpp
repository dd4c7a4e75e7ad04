// Adds up what the rows have found in a step: the contacts that State has next, forces at nodes, resultants on rigid bodies,
// energies, depths. Serial, as it is little beside finding them.
//
// Energies and resultants are summed exactly by the rank that finds a contact, so that no order changes a bit. Forces at
// nodes are added in the order of contacts, by all ranks alike.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct FoundPair; // contact/pairs/pair_contacts.hpp

class FoundContacts {
public:
  FoundContacts(const Model&, State&, ContactWork&);

  // Found by this rank: first all springs, then edges, in the order of their rows.
  void add(const ContactChunk&, Contact::Kind);

  // Tells the other ranks, and puts the contacts into State.
  ContactSums end();

private:
  void add(const Contact&, const ContactForce&, Contact::Kind);
  void add_energies_of_pairs(); // of those that this rank found
  void add_pairs();
  void add_pair(const FoundPair&);
  void add_depth(const FoundPair&);
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
  ExactSum friction_, damping_, breaking_; // J
  std::array<std::vector<ContactForce>, 2>
      told_; // to all ranks: of what deforms, per kind, in the order of rows
};

} // namespace cdem
