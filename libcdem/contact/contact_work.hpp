// What contact needs beside Model and State and throws away with its stage: which triangles and edges are near enough
// to look at, and the forces of the step.
//
// A pair found near sleeps until its two blocks have moved as far as it was apart: `wake` is compared with the sum of
// the ways the two have gone since the search. A row sleeps as long as all its pairs must.
#pragma once

#include "libcdem/contact/contact.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"

#include <array>
#include <vector>

namespace cdem {

inline constexpr std::int64_t contact_rows_per_chunk = 64;

struct ContactCandidate {
  int target = 0;  // triangle or edge
  double wake = 0; // m
};

// The targets near one source (triangle or edge), by piece and number.
struct ContactRow {
  int source = 0;
  double reach =
      0; // m, its contacts are at most that deep, and what is further off may sleep; 0: not looked at yet
  double wake = 0; // m, of its targets the least
  std::int64_t begin = 0, end = 0;
};

// Where a contact acts: at a place of the source's triangle, and on the corners of the tet behind the target's. The
// normal force acts at the target's nearest place, along the line of the two; the shear force at the source's place on
// both, so that neither turns anything.
struct ContactArms {
  std::array<int, 3> source{};
  std::array<int, 4> target{};
  std::array<double, 3> on_source{};       // weights, their sum 1
  std::array<double, 4> normal{}, shear{}; // weights, their sums 1
};

struct ContactForce {
  ContactArms arms;
  geom::Vec3 normal = geom::Vec3::Zero(), shear = geom::Vec3::Zero(); // N, on the source
  double stiffness = 0;                                               // N/m
};

// What one chunk of rows found in a step.
struct ContactChunk {
  std::vector<Contact> contacts;
  std::vector<ContactForce> forces;
  double friction = 0; // J
};

struct ContactWork {
  std::array<std::vector<ContactRow>, 2> rows; // of springs, of edges
  std::array<std::vector<ContactCandidate>, 2> candidates;
  std::vector<int> piece;               // per triangle: what holds together, by its smallest node
  std::vector<char> active;             // per triangle: it is outside, or its face has broken
  std::vector<double> travelled;        // m, per block, at most, since the search
  double furthest = 0;                  // m, of any block
  std::vector<double> last_way;         // m, per block, at most, in the last step
  double skin = 0;                      // m
  double shallow = 0;                   // m, the least reach of a row
  double usual_height = 0;              // m, of a tet at the surface
  bool search_due = true;               // faces have broken, or nothing was searched yet
  bool due = true;                      // something moved since the contacts were looked at
  double step = 0;                      // s, since then
  std::int64_t searches = 0, pairs = 0; // candidates of springs at the last search

  std::vector<ContactChunk> chunks;
  std::vector<double> stiffness; // N/m, of contacts at nodes, row sums (n_nodes)
  std::vector<int> touched;      // nodes with a force, in the order of the contacts
};

} // namespace cdem
