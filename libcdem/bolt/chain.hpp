// Forces along a bolt: a chain of steel segments between nodes that the grout holds to the rock. It has no mass and is in
// balance at any time,
//
//   g_i + N_i - N_{i-1} = 0,   g_i = k_i (u_i - a_i - s_i), |g_i| <= F_i,   N_i = (EA / l)(a_{i+1} - a_i - e_i), |N_i| <= N_y
//
// u: of the rock, a: of the steel, s: slip of the grout, e: stretch of the steel that stays; both perfectly plastic. The
// balance is found by Newton's method on the convex energy of the chain.
#pragma once

#include "libcdem/bolt/bolt.hpp"

#include <vector>

namespace cdem {

// One bolt's numbers, node by node; the last segment entries are unused.
struct BoltChain {
  std::vector<double> grout, strength; // N/m, N (n)
  double steel = 0;                    // EA / l, N/m
  double yield = 0;                    // N
};

struct ChainLoss {
  double slip = 0, yield = 0; // J, by the grout and the steel, from the forces before to those after
};

// Advances the nodes to the rock displacements `rock` (m, since the bolt was set), of the same number.
ChainLoss advance(const BoltChain&, const std::vector<double>& rock, BoltNode* nodes);

double stored_energy(const BoltChain&, const BoltNode* nodes, std::size_t count); // J

} // namespace cdem
