// Eight springs at a time, of a chunk: bonds far from their strength and contacts with friction, which is what nearly all
// springs are (joint/spring_law.hpp). What may break, or has been left to contact, is left to the caller.
#pragma once

#include "libcdem/bond/bond_work.hpp"

namespace cdem {

// R of interfaces eight by eight (bond/interface_frame.hpp): rotation[0] that of the first interface of batch
// frames.begin; nine numbers each, column by column. u: displacements.
void interface_rotations(const SpringBatches&, Range frames, const Node* displacement, double* rotation);

// Arrays of all springs of the model that contacts need in a step in time.
struct ContactsInTime {
  const double* rest_rate = nullptr; // as in BondWork, as all of these
  double *usual_force = nullptr, *rested = nullptr;
  double contact_damping = 0, damping_step = 0; // s
  const Node* velocity = nullptr;
  geom::Vec3* viscous = nullptr; // null: no dashpots
};

// One batch: what a step writes of its springs.
struct SpringsOfBatch {
  const Node* displacement = nullptr;
  const double* rotation = nullptr; // of interface `first_interface`, as above; null where none turns
  int first_interface = 0;
  const std::uint8_t* mode = nullptr;                                // the first spring's
  geom::Vec3 *offset = nullptr, *force = nullptr, *acting = nullptr; // acting: null where force acts
  bool breaking = false;
  const ContactsInTime* contacts = nullptr; // null: no time passes
  std::int64_t first = 0;                   // spring, of all
};

struct SpringSpent {
  double friction = 0, damping = 0; // J, added to
};

// Returns the lanes that it has left alone, a bit each.
unsigned plain_springs(const SpringBatches&, const SpringBatch&, const SpringsOfBatch&, SpringSpent&);

} // namespace cdem
