// Which piece of a model is the furthest from balance. The residual of a relaxation is a norm over the whole model, in which a small
// piece that slides does not show. With its nodes i and the joint springs p between it and others a piece is out of balance by
//
//   sum |out of balance|_i / (sum (|load| + |initial stress| + |contact| + |reaction|)_i + sum |spring|_p)
//
// Pieces are what unbroken bonds hold together (bond/fragments.hpp). A piece on which no load acts does not count.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// Larger than that, a piece slides or falls, or has not come to rest.
constexpr double out_of_balance_of_piece = 0.01;

struct LoosestPiece {
  double out_of_balance = 0; // part of the forces on it
  int node = -1;             // its smallest; -1: no load acts on any
};

// All ranks call it together, where the state's surfaces are whole. force: N, net (n_nodes), of all ranks; what else acts is in the
// workspace.
LoosestPiece loosest_piece(const Model&, const State&, Workspace&, const std::vector<Node>& force);

} // namespace cdem
