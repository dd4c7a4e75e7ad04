// What contacts add to the bounds of the largest eigenvalue of stiffness over mass (Gershgorin), for the stable step.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

// s: `safety` times a bound of the stable step of all nodes and rigid bodies that contacts act on, as they are now;
// Infinite without contacts.
struct ContactStep {
  const std::vector<double>& row_sums; // N/m, of elements and bonds (n_nodes)
  bool damped = false;                 // stiffness damping acts
  double joint_damping = 0;            // s, of springs of interfaces that are contacts
  double safety = 1;
  bool given = false; // the user has given a step: that of rigid bodies may be most_rigid_time_step
};
double contact_time_step(const Model&, const State&, const ContactLoads&, const ContactStep&);

// s, likewise, of rigid bodies before any contact, if a fiftieth of their surface comes into contact: a step that lets
// no more than a few contacts close at once. contact_time_step shortens it when more do. Infinite without rigid bodies.
double rigid_time_step(const Model&, double safety);
double most_rigid_time_step(const Model&);                                          // s, that a user may give
double rigid_time_step(const Model&, const std::vector<RigidBody>&, double safety); // of these blocks

// s, `safety` times the stable step of nodes at surfaces whose contacts are given a stiffness, as if all semi-springs of
// its own side were pressed: a contact that closes within a step must not be too stiff for that step, since contact_time_step shortens
// the next one only. Contacts as stiff as their tets are no stiffer than what the step is for. Infinite without.
double closing_time_step(const Model&, double safety);

// N/m (n_nodes), of elements and such contacts where there are some, else 0.
std::vector<double> closing_row_sums(const Model&);

// m, from each rigid body's centroid to its furthest node; it keeps its shape.
std::vector<double> reaches_of_rigid(const Model&, const State&);
// s, in which no point of a rigid body goes further than a tenth of the usual height of the tets at any surface, moving
// as it does now: a contact is found before it is too deep, and nothing passes through anything. Infinite at rest.
double displacement_time_step(const Model&, const State&, const std::vector<double>& reaches);

// 1/s2, per rigid body: the square of the circular frequency at which it bounces, its stiffest flat face or corner pressed.
std::vector<double> impact_frequencies2(const Model&);

// s: a step for rigid bodies that are about to meet others: 0.3 of the stable one of an impact, and a fifth of that for those in
// flight, so that an impact keeps its energy: what contact_law.hpp leaves of its error is (omega dt)^4 of it.
struct Flight {
  const std::vector<double>& impact_frequency2;       // 1/s2, per rigid body
  const std::vector<std::optional<geom::Vec3>>& held; // ResolvedConditions::rigid
  double gravity = 0;                                 // m/s2
  double safety = 1;
  bool damped = false; // all impacts lose energy by local damping
};
// A body is in flight if it is not damped and hops higher than its weight presses it in. Infinite where all touch or are held.
double flight_time_step(const Model&, const State&, const ContactLoads&, const Flight&);

// Adds to the row sums what contacts may at most add at the surface, when all of it is pressed by its like, N/m.
void add_contact_row_sums(const Model&, std::vector<double>& row_sums);

} // namespace cdem
