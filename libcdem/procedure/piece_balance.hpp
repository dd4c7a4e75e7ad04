// Which pieces of a model are out of balance. The residual of a relaxation is a norm over the whole model, in which a small piece that
// slides does not show. So each piece counts for itself: with its nodes i and the joint springs p between it and others it is in
// balance where
//
//   sum |out of balance|_i <= 0.001 (sum (|load| + |initial stress| + |contact| + |reaction|)_i + sum |spring|_p)
//
// Pieces are what unbroken bonds hold together (bond/fragments.hpp). A piece on which no load acts is left to the residual.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

struct LoosePieces {
  std::vector<char>
      nodes;         // whether they belong to one of these pieces (n_nodes); empty: all pieces are in balance
  bool fall = false; // they touch nothing
  double of_residual = 1; // their part of the norm of the forces out of balance
  std::vector<Node> load; // N, on all nodes
};

// Pieces that touch nothing may fall onto others that have sunk: they are told only where no other piece is out of balance.
// goal: of the residual; a larger one than 0.001 takes its place. force: N, net (n_nodes), of all ranks; what else acts is in the
// workspace. All ranks call it together, where the state's surfaces are whole.
LoosePieces loose_pieces(const Model&, const State&, Workspace&, const std::vector<Node>& force, double goal);

} // namespace cdem
