// Contact between the tetrahedra of one broken body (contact/pairs/tet_pressure.hpp), and the lists that tell which pairs
// are computed in a step. The lists live for one stage and change no force: a pair that presses, or began to, is in them.
//
// *Outer list*: pairs of tetrahedra with a corner on the outside or at a crack, which one of their planes parts by less
// than their two skins; and pairs around cracks that still hang together. It is made anew when a tetrahedron has used up its
// skin, or a crack has left the tetrahedra of the list.
// *Sleep*: a tetrahedron adds up its path, seen from a frame that moves with the mean of all. A pair sleeps until the
// paths of both have reached its wake: they were as far apart when it was last computed.
// *Inner list*: the pairs that may wake before some tetrahedron has gone so far as in the next steps.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/pairs/tet_joints.hpp"
#include "libcdem/contact/pairs/tet_pressure.hpp"

namespace cdem {

struct FoundPair {
  TetContact contact;
  TetPressure pressure = {};
  double shear_stiffness = 0; // N/m
  double breaking = 0;        // J, that a face stored and the contact does not
  bool stays = true;          // it is a contact of State
};

struct PairContacts {
  std::vector<char> paired; // per block: its tetrahedra are pairs
  TetJoints joints;
  // Tetrahedra of the lists, ascending, by their numbers there.
  std::vector<int> tets;
  std::vector<int> number;               // per tet of the mesh; -1: not in the lists
  std::vector<char> around_cracks;       // pairs that hang together are listed
  std::vector<std::uint8_t> open;        // planes, a bit each, by the corner opposite
  std::vector<std::int32_t> node;        // of the model, four each
  std::vector<Node> undeformed;          // m, four each
  std::vector<Node> place, velocity;     // m, m/s, four each; velocity: of those that press
  std::vector<double> size;              // m, mean height
  std::vector<double> area;              // m2, mean of the four faces
  std::vector<double> compliance;        // m/Pa
  std::vector<double> mass;              // kg
  std::vector<float> path, step_path;    // m, since the outer list was made; in the last step
  std::vector<float> skin, until;        // m, of path: the outer list holds so long, and the inner one
  geom::Vec3 shift = geom::Vec3::Zero(); // m, of the frame in a step
  bool outer_due = true, inner_due = true;
  // Pairs of the outer list, by the numbers of both.
  std::vector<std::int32_t> a, b;
  std::vector<float> wake;             // m, of both paths
  std::vector<std::uint8_t> apart;     // 1: they may touch
  std::vector<std::uint8_t> in_place;  // as TetJoints says
  std::vector<std::int32_t> entry;     // into `known`; -1: none
  std::vector<std::int32_t> inner;     // pairs
  std::vector<TetContact> known;       // of State::tet_contacts, those of this rank
  std::vector<std::int32_t> known_row; // their pairs
  std::vector<FoundPair> found;        // in this step, by pair
};

// Where the nodes are, and how far they have gone. True when the lists have to be made anew; all ranks agree.
bool advance_pairs(const State&, ContactWork&, int threads);
// Renews the lists as far as it is due.
void renew_pairs(const Model&, const State&, ContactWork&, int threads);
// Nodes that this rank reads.
std::vector<std::int32_t> nodes_of_pairs(const ContactWork&);
// Finds the pairs that press, or carry nothing at the depth at which they were found: PairContacts::found.
void evaluate_pairs(const Model&, const State&, ContactWork&, int threads);

// J, that they store at these displacements.
double stored_in_pairs(const Model&, const State&, double lag);

} // namespace cdem
