// Contact of a meshed block with itself once faces of it have broken: pairs of its tetrahedra. They live for one stage.
//
// Tetrahedra that hang together at a node never touch: around each node of the mesh, the copies whose tetrahedra are joined
// by faces that have not lost all their strength are one joint. All others at the surface may touch
// (response/tet_potential.hpp). A pair that is further apart sleeps until its two tetrahedra have gone so far past each other.
// What is skipped changes no force.
#pragma once

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/parallel/node.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace cdem {

// A tetrahedron that is at the surface of its block, or may be so before long.
struct SurfaceTet {
  int tet = 0, block = 0;
  geom::Tet nodes{};
  TetSize size;
  bool at_surface = false; // one of its nodes is
};

// How far a tetrahedron has moved as a whole since the pairs were found, and the most that a corner differs from that, m.
struct TetMotion {
  std::array<float, 3> drift{};
  float swing = 0;
};

// How two tetrahedra stood to each other when they were last looked at, and how far they may go past each other from there.
struct TetPairMotion {
  std::array<float, 3> drift{}; // m, of the second past the first
  float swings = 0;             // m, of both
  float allowed = 0;            // m; 0: they touch, or have not been looked at
};

struct TetContacts {
  static constexpr float never = std::numeric_limits<float>::infinity();

  std::vector<SurfaceTet> tets; // of blocks that touch themselves, ascending
  std::vector<int> number;      // per tetrahedron of the model: in `tets`; -1: not there
  std::vector<int> nodes;       // of them, ascending within each block
  std::vector<int> nodes_begin; // by block that touches itself, into nodes
  std::vector<Node> place, place_at_first; // m, (n_nodes), of those nodes: now, and when the pairs were found
  std::vector<double> way;                 // m, (n_nodes), of them in the last step, past the mean of their block
  std::vector<double> path;                // m, per tetrahedron: the sum of the longest way of its nodes
  std::vector<int> joint;                  // (n_nodes), the smallest node of the joint
  std::vector<std::pair<int, int>> held;   // tetrahedra whose common face is broken and held by its own springs
  double skin = 0;                         // m, how far any may go before the pairs are found anew

  // Pairs, into `tets`, a < b; by a, then b.
  std::vector<int> a, b;
  std::vector<float> slack; // m, overlap at which a pair begins to press
  std::vector<float> until; // m, of the paths of both: it is skipped so long; never: they may not touch
  std::vector<TetPairMotion> motion;
  bool fresh = true; // some pairs may not touch any more: their contacts have ended

  // Pairs that may wake before any tetrahedron has gone as far as its `limit`.
  std::vector<int> near, near_a, near_b;
  std::vector<float> near_until;
  std::vector<double> limit;        // m, of path
  std::vector<std::uint64_t> awake; // a bit per near pair

  std::vector<TetMotion> moved;        // per tetrahedron
  std::vector<std::int64_t> moved_at;  // per tetrahedron: the step in which `moved` was found
  std::int64_t steps = 0;
};

// What a pair did in a step.
struct TetPairForce {
  int block = 0;
  std::array<int, 8> node{};         // of the model
  std::array<geom::Vec3, 8> force{}; // N
  std::array<double, 8> stiffness{}; // N/m, at each
};

} // namespace cdem
