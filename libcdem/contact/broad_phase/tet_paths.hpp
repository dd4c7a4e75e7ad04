// How far tetrahedra go, and which pairs of them may have come together since they were last looked at: kernels.
#pragma once

#include "libcdem/parallel/node.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace cdem {

// What tetrahedra have gone since their pairs were found, m, one array each. Of two places in two tetrahedra the one goes past the
// other by no more than |drift - drift| + swing + swing of what both have gone.
struct TetPaths {
  std::vector<double> path;                 // sum of what the fastest corner goes past the frame
  std::vector<double> swing;                // sum of what it goes past the middle
  std::array<std::vector<double>, 3> drift; // of the middle, past the frame
  std::array<std::vector<float>, 4> now;    // drift and swing

  void assign(std::size_t count);
  void copy(std::size_t from, const TetPaths& before, std::size_t to);
  void clear(std::size_t tet);
};

// Adds a step of the tetrahedra [begin, end). corner: their nodes. velocity, frame: m/s; step: s. Paths and swings are rounded up.
void add_step(const Node* velocity, const Node& frame, double step,
              const std::array<std::vector<int>, 4>& corner, int begin, int end, TetPaths&);

// Pairs of tetrahedra that were looked at: how they stood then, and how far they may go past each other from there, m.
struct WatchedPairs {
  std::vector<int> a, b;
  std::array<std::vector<float>, 4> then; // drift of b past that of a; swings of both
  std::vector<float> allowed;             // 0: is to be looked at

  std::size_t count() const { return a.size(); }
  void clear();
  void add(const WatchedPairs& before, std::size_t place, int one, int other);
  // Takes the pair as it stands now.
  void set(std::size_t place, const TetPaths&, float may_go);
};

// Writes a bit for each that is to be looked at, 64 in a word.
void find_awake(const TetPaths&, const WatchedPairs&, std::vector<std::uint64_t>& awake);

} // namespace cdem
