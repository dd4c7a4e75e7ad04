// What a search renews: the fragments that are new or have moved out of their skins; of those on which faces have broken,
// what stands around these. Everything else stays as it was found.
#pragma once

#include "libcdem/contact/broad_phase/near_triangles.hpp"

namespace cdem {

// What a search renews. The rows of all others stay as they are.
struct Renewed {
  bool all = true;            // movers; but rigid pairs may keep their rows
  std::vector<char> movers;   // per mover
  std::vector<char> blocks;   // per block: one of its movers, or something on it
  std::vector<char> surfaced; // per mover: new surface of it has opened, and so rows of other blocks with it
  std::vector<char> edges;    // per edge: of such a mover, new, or where something has changed
  // Per edge as it was numbered before, its number now; -1: it is no more. Empty: as before.
  std::vector<int> edge_now;
  // Per rigid pair as it was numbered before, its number now; -1: its rows are found anew.
  std::vector<int> pair_now;
};

// Share of a skin: a fragment with less left is searched with the first that leaves its own.
inline constexpr double searched_with_others = 0.6;

// Movers that are new, and those that have left their skins or soon will, or all. Other rows of what has changed are looked at
// in this step.
Renewed movers_to_search(const Model&, ContactWork&, bool all);
// Writes Renewed::edges and edge_now. before: the edges by the numbers they had.
void edges_to_search(const Model&, const Movers&, const SurfaceEdges&, const std::vector<ContactEdge>& before,
                     bool fragments_due, Renewed&);

} // namespace cdem
