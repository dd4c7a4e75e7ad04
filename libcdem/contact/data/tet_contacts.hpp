// Contact of a meshed block with itself once faces of it have broken: pairs of its tetrahedra. They live for one stage.
//
// Tetrahedra that hang together at a node never touch: around each node of the mesh, the copies whose tetrahedra are joined
// by faces whose own springs act are one joint, whether these faces hold or are the contact that a broken bond is. All others at the surface may touch
// (response/tet_potential.hpp). A pair that is further apart sleeps until its two tetrahedra have gone so far past each other.
// What is skipped changes no force.
#pragma once

#include "libcdem/contact/broad_phase/tet_paths.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/parallel/node.hpp"

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace cdem {

// A tetrahedron that is at the surface of its block, or may be so before long.
struct SurfaceTet {
  int tet = 0, block = 0;
  geom::Tet nodes{};
  TetSize size;
  bool at_surface = false; // one of its nodes is
};

struct TetContacts {
  std::vector<SurfaceTet> tets;           // of blocks that touch themselves, ascending
  std::vector<int> number;                // per tetrahedron of the model: in `tets`; -1: not there
  std::vector<int> nodes;                 // of them, ascending within each block
  std::vector<int> nodes_begin;           // by block that touches itself, into nodes
  std::vector<Node> place;                // m, (n_nodes), of those nodes
  std::array<std::vector<int>, 4> corner; // nodes of the tetrahedra
  std::vector<int> tets_begin;            // by block that touches itself, into tets
  TetPaths paths;                         // of the tetrahedra
  // m, that each stays in until its path exceeds the skin, in the frame of its block.
  std::vector<geom::Box> boxes;
  std::vector<geom::Vec3> way; // m, of that frame, by block of the model
  std::vector<std::array<int, 4>>
      joint;       // of the corners, the smallest node of the joint when contact was last told
  double skin = 0; // m, how far any may go before its pairs are found anew

  // Pairs, into `tets`, a < b; by a, then b.
  WatchedPairs pairs;
  std::vector<char> may_touch;
  bool fresh = true; // some pairs may not touch any more: their contacts have ended

  // Pairs that may wake before the path of any tetrahedron reaches its `limit`.
  WatchedPairs near;
  std::vector<int> place_of_near;                // of each in `pairs`
  std::vector<std::pair<int, int>> tets_of_near; // of the model
  std::vector<double> limit, path_then;          // m; what the paths were when they were found
  std::int64_t steps = 0, steps_then = 0;
  std::vector<std::uint64_t> awake; // a bit per near pair

  int pair_of(int tet, int other) const; // of the model, tet < other; -1: none
};

// What a pair did in a step.
struct TetPairForce {
  int block = 0;
  std::array<int, 8> node{};         // of the model
  std::array<geom::Vec3, 8> force{}; // N
  std::array<double, 8> stiffness{}; // N/m, at each
};

} // namespace cdem
