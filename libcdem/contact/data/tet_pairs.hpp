// Pairs of fragments of one body that are single tetrahedra, near each other. They live for one stage.
//
// A tetrahedron is convex, and its four triangles are its surface. So the semi-springs of such a pair need no list of
// candidates: the planes of one tetrahedron tell which semi-springs of the other one are outside, by how much at least,
// and to which triangle those inside are nearest. A pair is skipped until its two tetrahedra have moved relative to each
// other by the least of these distances.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace cdem {

inline constexpr std::int64_t tet_pairs_per_chunk = 1024; // a multiple of contact_rows_per_chunk

// A mover that is a single tetrahedron.
struct TetShape {
  std::array<int, 4> nodes{};                           // of the model
  std::array<int, 4> triangles{-1, -1, -1, -1};         // by number; -1: no single tetrahedron
  std::array<std::array<std::uint8_t, 3>, 4> corners{}; // of each triangle, into nodes
  std::array<int, 4> mates{}; // of triangles: on the other side of their faces, by number
  double height = 0;          // m, the largest behind a triangle, undeformed
};

// The places of its nodes, and its planes, in this step.
struct TetPlanes {
  std::array<geom::Vec3, 4> x;      // m, of nodes
  std::array<geom::Vec3, 4> normal; // unit, outwards, of triangles
};

// How its two movers stood at the last check of a pair, and how far they may go from there, m (as in ContactRow).
struct PairMotion {
  float allowed = 0, swings = 0;
  std::array<float, 3> drifts{};
};

// A contact of a pair: in which chunk, and its number there.
struct PlaceOfFound {
  int chunk = 0, number = 0;
};

struct TetPairs {
  std::vector<int> a, b;            // movers, a < b; by a, then b
  std::vector<float> until;         // m, per pair, of what both have travelled: it is skipped so long
  std::vector<PairMotion> motion;   // per pair
  std::vector<std::uint64_t> awake; // a bit per pair: it is computed in this step
  std::vector<TetShape> shape;      // per mover; written by a search
  std::vector<TetPlanes> now;       // per mover, of those in pairs that are awake
  std::vector<char> in_awake;       // per mover: it is in such a pair
  std::vector<int> movers_awake;    // those
  std::vector<int>
      contact_begin; // (n_triangles + 1) springs before the step, into State::contacts, by triangle
  std::vector<ContactChunk> found; // in this step, per chunk of pairs
  std::vector<PlaceOfFound>
      ordered; // the same in the order in which rows stand: by triangle, fragment, corner

  std::size_t count() const { return a.size(); }
};

} // namespace cdem
