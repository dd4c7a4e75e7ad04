// Bolts in the rock: where their nodes are held, and the forces they put on the rock's nodes along their axis.
#pragma once

#include "libcdem/bolt/chain.hpp"
#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// A place in a tetrahedron: its nodes and their weights.
struct RockPlace {
  geom::Tet nodes{};
  std::array<double, 4> weights{};
  bool inside = false;
};
RockPlace rock_place(const Model&, const geom::Vec3& place); // undeformed, m

struct ResolvedBolt {
  BoltChain chain;
  std::vector<RockPlace> at;
  geom::Vec3 direction = geom::Vec3::Zero(); // unit, from -> to
  std::size_t first = 0;                     // into State::bolts
};

// Nodes of rock that has been taken out hold nothing. Throws geom::InputError where the state has other bolts.
std::vector<ResolvedBolt> resolve_bolts(const Model&, const State&, const std::vector<Bolt>&);

// Sets a bolt into the rock as it stands now; throws geom::InputError when one of its ends lies outside.
void set_bolt(const Model&, State&, const Bolt&);

// The forces on the rock of the last advance.
void bolt_forces(const std::vector<ResolvedBolt>&, const State&,
                 std::vector<std::pair<int, geom::Vec3>>& forces);

// Advances all bolts to where the rock is, books what they take in the ledger, and replaces `forces` on the rock.
void advance_bolts(const std::vector<ResolvedBolt>&, State&, std::vector<std::pair<int, geom::Vec3>>& forces);

void add_bolt_row_sums(const std::vector<ResolvedBolt>&, std::vector<double>& sums); // N/m (n_nodes)

} // namespace cdem
