// The candidates: triangles and edges that are near each other, as a search has found them.
//
// A near pair is skipped until its two blocks have moved by its distance: `recheck_distance` is compared with the sum of
// the distances that the two have moved since the search. A row is skipped as long as all its pairs are. Lengths stored
// as floats are rounded such that more pairs are checked, never fewer. Two rigid convex blocks have rows of their own.
// These rows depend on the relative motion of the two (RigidPair) and stay as long as that motion is within the skin of
// the pair.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace cdem {

inline constexpr std::int64_t contact_rows_per_chunk = 64;

struct ContactCandidate {
  std::uint32_t target : 29; // triangle or edge
  // In the row of a triangle: which of its three semi-springs may come near the target. In the row of an edge: 1 if the
  // pair is skipped only as long as no contact stands on the neighbouring edges.
  std::uint32_t springs : 3;
  float recheck_distance; // m
};
inline constexpr std::uint32_t last_contact_triangle = (1u << 29) - 1;

inline float rounded_down(double length) { // at least 0
  return length > 0 ? static_cast<float>(length * (1 - 2e-7)) : 0;
}

// The targets near one source (triangle or edge) of one fragment, by number.
struct ContactRow {
  int source = 0;
  int source_block = 0, block = 0;    // of the source, and of its targets
  int fragment = -1;                  // of its targets: ContactFragments::number_of_triangle
  std::uint32_t begin = 0, count = 0; // into candidates
  // m, candidates further away may be skipped. For springs: contacts are at most that deep; 0: not computed yet. For
  // edges: the depth that any contact may reach before the next search.
  float reach = 0;
  float recheck_distance = 0; // m, of its targets the least
  bool hindered = false;      // of edges: some sleep only as long as no contact stands on the edges around
  // The targets of this row of springs belong to several blocks, which bonds hold together; `block` is that of the first.
  bool several_blocks = false;
  std::uint8_t plane = 0; // of springs: which of the planes of their target parted them best, from 0
  int pair = -1;          // of two rigid convex blocks, into RigidPairs::all; -1: of others
  int place = -1;         // into RowsAsleep::of_pairs
  // Per semi-spring, of what was found when all its targets were last looked at: until the two blocks have gone so far, m,
  // it touches nothing (target -1) or nothing but this triangle.
  std::array<float, 3> known_until{};
  std::array<int, 3> known_target{-1, -1, -1};
};

// Rows of rigid pairs, those of one pair side by side.
struct RowsOfPairs {
  std::vector<int> begin;   // (n_pairs + 1)
  std::vector<int> row;     // by pair, ascending
  std::vector<float> until; // m, of RigidPair::moved: the row sleeps so long
};

// What tells of all rows which ones sleep, side by side: it is gone through in every step.
struct RowsAsleep {
  std::vector<float>
      recheck_distance; // m, per row; 0 where more than that decides; infinite for those of rigid pairs
  RowsOfPairs of_pairs;
  std::vector<int> source_block, block; // per row
  std::vector<std::uint64_t> hindered;  // per chunk of rows, a bit each: ContactRow::hindered
  std::vector<std::uint64_t> awake;     // per chunk of rows, a bit each: it is looked at in this step
};
static_assert(contact_rows_per_chunk == 64, "a bit per row");

// Rows of one kind, of the sources that this rank keeps. Written by make_rows; rows and candidates that are looked at say
// when they are looked at next.
struct ContactRows {
  std::vector<ContactRow> all; // by source
  std::vector<ContactCandidate> candidates;
  RowsAsleep asleep;
};

} // namespace cdem
