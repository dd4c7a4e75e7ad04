// Contact of a meshed block with itself once faces of it have broken: pairs of its tetrahedra. They live for one stage.
//
// Tetrahedra that hang together at a node never touch: around each node of the mesh, the copies whose tetrahedra are joined
// by faces that have not lost all their strength are one joint. All others may touch (response/tet_potential.hpp).
// A pair that is further apart sleeps until its two tetrahedra have gone so far past each other. What is skipped changes no
// force.
#pragma once

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/state/contact.hpp"

#include <cstdint>
#include <vector>

namespace cdem {

// A tetrahedron with a node on the surface of its block, as it is now.
struct SurfaceTet {
  int tet = 0, block = 0;
  TetSize size;
};

struct TetContacts {
  std::vector<SurfaceTet> tets;    // of blocks that touch themselves, ascending
  std::vector<double> path;        // m, of each, at most, past the mean motion of its block, since the pairs were found
  double skin = 0;                 // m, how far any may go before the pairs are found anew
  std::vector<int> nodes;          // of them, ascending
  std::vector<int> block_of_nodes; // blocks with such nodes, and where theirs begin
  std::vector<int> nodes_begin;
  std::vector<Node> place; // m, (n_nodes), of those nodes
  std::vector<double> way; // m, (n_nodes), of those nodes, in the last step, past the mean of the block
  std::vector<int> a, b;   // pairs, of `tets`, a < b; by a, then b
  std::vector<float> until;         // m, of what both have gone: it is skipped so long
  std::vector<std::uint64_t> awake; // a bit per pair
  bool fresh = true;                // the pairs have just been found: contacts of others have ended
};

// What a pair did in a step.
struct TetPairForce {
  int block = 0;
  std::array<int, 8> node{};          // of the model
  std::array<geom::Vec3, 8> force{};  // N
  std::array<double, 8> stiffness{};  // N/m, at each
};

} // namespace cdem
