// Effects of the contacts of a step.
#pragma once

#include "libcdem/contact/data/rigid_sums.hpp"
#include "libcdem/integrate/contact_on_rigid.hpp"
#include "libcdem/parallel/node.hpp"
#include "libcdem/state/contact.hpp"

#include <array>
#include <vector>

namespace cdem {

// Where a contact acts: at a place of the source's triangle, and on the corners of the tet behind the target's. The
// normal force acts at the target's nearest place, along the line of the two; the shear force at the source's place on
// both, so that neither turns anything. Nearly parallel edges have one place, on the tets behind both.
struct ContactArms {
  std::array<int, 4> source{}, target{};
  std::array<double, 4> on_source{};       // weights, their sum 1
  std::array<double, 4> normal{}, shear{}; // weights, their sums 1
};

struct ContactForce {
  ContactArms arms;
  int source_block = 0, target_block = 0;
  geom::Vec3 normal = geom::Vec3::Zero(), shear = geom::Vec3::Zero(); // N, on the source
  geom::Vec3 moment = geom::Vec3::Zero();                             // N m, on the source, beside them
  double stiffness = 0;                                               // N/m
  double friction = 0, damping = 0;                                   // J, this step
};

struct ContactSums {
  double friction = 0, damping = 0; // J, this step, rounded once
  std::int64_t contacts = 0;        // of all ranks
  // The deepest, in parts of the depth at which a contact is not to be trusted (depth_limit).
  double deepest = 0;
  double depth = 0, depth_over_height = 0;      // largest, m and in parts of the lower tet's height
  int deepest_source = -1, deepest_target = -1; // triangles
};

// What one chunk of rows found in a step.
struct ContactChunk {
  std::vector<Contact> contacts;
  std::vector<ContactForce> forces;
  ContactSums sums;
};

struct TouchedNode {
  int node = 0, block = 0;
};

// The forces of contacts on what they touch; written by FoundContacts.
struct ContactLoads {
  std::vector<Node> force;          // N, of contacts (n_nodes); empty without
  std::vector<double> stiffness;    // N/m, of contacts at nodes, row sums (n_nodes)
  std::vector<TouchedNode> touched; // nodes with a force, in the order of the contacts; none of rigid bodies
  // Per rigid body: the sums as contacts are added, and their values, which all ranks know.
  std::vector<RigidSums> rigid_sums;
  std::vector<ContactOnRigid> on_rigid;
};

} // namespace cdem
