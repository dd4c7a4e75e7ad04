// Forces of all springs, bonds and contacts alike, with breaking; each chunk of springs writes only its own
// springs.
#pragma once

#include "libcdem/bond/bond_work.hpp"
#include "libcdem/parallel/read_ahead.hpp"

namespace cdem {

// One chunk of springs. Reads displacement; writes spring_force, acting_force and stretch of BondWork, the sums and, where a spring breaks,
// slips, opens or softens, bond_mode, bond_offset, bond_damage, bond_slip and joint_history; in a step in time, of contacts,
// usual_force and rested.
void spring_forces(const Model&, State&, BondWork&, std::int64_t chunk, bool breaking);

// The springs of one interface without a whole bond where its nodes are now. Returns what slip has taken since they were
// last looked at, J.
double catch_up(const Model&, State&, BondWork&, const Interface&);

// Adds what bonds do to nodes, force[0] the first of them, N; bond_force: BondWork::force().
void add_bond_forces(const Model&, const std::vector<geom::Vec3>& bond_force, Range nodes, Node* force);

// What add_bond_forces reads for a chunk of Model::chunks.
void add_bond_reads(const Model&, const BondWork&, std::int64_t chunk, ReadAhead&);

// Forces of the present state without any breaking or slip. The energy losses of the first step are counted from them.
void start_spring_forces(const Model&, const State&, BondWork&);

// Writes usual_force and rested of contacts that have been at rest for long, as after a relaxation.
void rest_contacts(const Model&, State&);

// Position of side b of a spring less that of side a, in space, m (bond/interface_frame.hpp: in undeformed directions):
// the relative displacement plus the undeformed distance of the two.
geom::Vec3 jump(const Model&, const std::vector<Node>& displacement, int point);

// Part of a spring that is a contact: 1 where it was never bonded or has broken, D of a bond that softens, else 0.
double broken_share(const State&, std::int64_t point);

// The interface has been handed over to contact: its springs carry nothing any more.
bool released(const State&, const Interface&);

// Traction that a spring carries at the present state in the interface's undeformed directions, Pa: positive normal part is tension.
geom::Vec3 traction(const Model&, const State&, int point);

// Adds `more` (Pa, undeformed directions) to the traction of the spring at its present relative displacement, by a
// change of its offset.
void add_traction(const Model&, State&, int point, const geom::Vec3& more);

// Lets a spring that has just become a contact slide to where friction holds it.
void settle(const Model&, State&, int point);

double spring_energy(const Model&, const State&, int point); // stored, J
// Stored energy of all springs, J.
double spring_energy(const Model&, const State&);

// Row sums of the springs' stiffness, N/m, added per node. A Gershgorin bound.
void add_spring_row_sums(const Model&, std::vector<double>& sums);

} // namespace cdem
