// What contact needs beside Model and State and throws away with its stage: which triangles and edges are near enough
// to look at, and the forces of the step.
//
// A search finds what can touch before a block has gone further than its skin; none of it changes a force. A pair found
// near sleeps until its two blocks have moved as far as it was apart: `recheck_distance` is compared with the sum of the ways the
// two have gone since the search. A row sleeps as long as all its pairs must. Lengths kept as floats are rounded to the
// side on which more is looked at.
#pragma once

#include "libcdem/model/contact_surface.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"
#include "libcdem/state/contact.hpp"

#include <array>
#include <limits>
#include <vector>

namespace cdem {

inline constexpr std::int64_t contact_rows_per_chunk = 64;
// Of the usual height of a tet at a block's surface: how deep a contact may be before the pairs around it are all looked
// at in every step.
inline constexpr double shallow_ratio = 0.01;

struct ContactCandidate {
  std::uint32_t target : 29; // triangle or edge
  // Of a triangle's row: which of its three semi-springs may come near the target. Of an edge's: 1 where it sleeps only as
  // long as no contact stands on the edges around.
  std::uint32_t springs : 3;
  float recheck_distance; // m
};
inline constexpr std::uint32_t last_contact_triangle = (1u << 29) - 1;

inline float rounded_down(double length) { // >= 0
  return static_cast<float>(length * (1 - 2e-7));
}

// The targets near one source (triangle or edge) of one fragment (springs) or block (edges), by number.
struct ContactRow {
  int source = 0;
  int block = 0;                      // of its targets
  std::uint32_t begin = 0, count = 0; // into candidates
  // m, what is further off may sleep. Of springs: contacts are at most that deep; 0: not looked at yet. Of edges: as deep
  // as any may get before the next search.
  float reach = 0;
  float recheck_distance = 0; // m, of its targets the least
  bool hindered = false;      // of edges: some sleep only as long as no contact stands on the edges around
  // Per semi-spring, of what was found when all its targets were last looked at: until the two blocks have gone so far, m,
  // it touches nothing (target -1) or nothing but this triangle.
  std::array<float, 3> known_until{};
  std::array<int, 3> known_target{-1, -1, -1};
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
  int source_block = 0, target_block = 0;
  geom::Vec3 normal = geom::Vec3::Zero(), shear = geom::Vec3::Zero(); // N, on the source
  double stiffness = 0;                                               // N/m
  double friction = 0, damping = 0;                                   // J, this step
};

struct ContactSums {
  double friction = 0,
         damping = 0; // J, this step: of contacts in their order, whichever chunks they stand in
  // The deepest, in parts of the depth at which a contact is not to be trusted (depth_limit).
  double deepest = 0;
  double depth = 0, depth_over_height = 0;      // largest, m and in parts of the lower tet's height
  int deepest_source = -1, deepest_target = -1; // triangles
};

// What one chunk of rows found in a step.
struct ContactChunk {
  std::vector<Contact> contacts;
  std::vector<ContactForce> forces;
  ContactSums sums;
};

// An edge in which the line of another continues over one of its ends.
struct EdgeBeyond {
  int edge = -1;
  double direction = 1; // 1 or -1: the line runs along the edge's own direction or against it
};

// Of a block as a whole.
struct BlockMotion {
  bool whole = false; // it has one
  geom::Vec3 centroid = geom::Vec3::Zero(), velocity = geom::Vec3::Zero(),
             spin = geom::Vec3::Zero(); // m, m/s, rad/s
};

struct TouchedNode {
  int node = 0, block = 0;
};

struct ContactWork {
  std::array<std::vector<ContactRow>, 2> rows; // of springs, of edges
  std::array<std::vector<ContactCandidate>, 2> candidates;
  std::vector<int> fragment;      // per triangle: what holds together, by its smallest node
  std::vector<char> active;       // per triangle: it is outside, or its face has broken
  std::vector<char> broken;       // per block: some of its faces have
  std::vector<ContactEdge> edges; // of surfaces as they are now, by id
  std::vector<int> edge_begin;    // (n_triangles + 1) into edges, by their first triangle
  // Per edge: where the edges of its fragment that meet at its two ends begin in edges_at.
  std::vector<std::array<int, 2>> edge_ends;
  std::vector<int> edges_at; // by end, each list closed by -1
  // Per edge and end: where the edges in which its line continues begin in edges_beyond.
  std::vector<std::array<int, 2>> edge_continues;
  std::vector<EdgeBeyond> edges_beyond; // by edge and end, each list closed by -1
  // Per edge, and per block: it had a contact of edges before the step.
  std::vector<char> edge_touched, block_edges_touched;
  std::vector<double> travelled;         // m, per block, at most, since the search
  std::vector<double> last_displacement; // m, per block, at most, in the last step
  std::vector<double> pace;              // the same, of the last step in which anything moved
  std::vector<double> skin;              // m, per block: how far it may go before the next search
  double undefined_pair_margin =
      0;                   // m, that two blocks for which no contact is given may go before a search is due
  double usual_height = 0; // m, of a tet at any surface: of skins, which change no force
  // m, per block, a part of what is usual at its own surface: so deep contacts may begin, and the least reach of a row.
  std::vector<double> shallow;
  bool fragments_due =
      true;        // faces have broken, or fragments were never told apart: a search is due with them
  bool due = true; // something moved since the contacts were looked at
  // State::contacts holds all there are, but for fragments. Not so where a stage begins: what stands in what then is
  // anybody's doing.
  bool history_complete = false;
  bool any_depth_begins =
      false;       // of this look: contacts begin however deep they are, as fragments were told apart anew
  double step = 0; // s, since then
  // Tangent of the largest friction angle of any contact, for a stage that wants less than joints give.
  double most_friction = std::numeric_limits<double>::infinity();
  bool restitution = false; // some contact law has one below 1, and the stage wants it
  std::vector<double>
      block_forces; // N, per block, of all springs that pressed on it before the step; with restitution
  std::vector<BlockMotion> block_motion; // per block, of those that touched before the step; with restitution
  int skin_doublings = 0; // how often skins have been doubled, as searches followed each other closely
  std::int64_t steps_since_search = 0; // steps since the search
  std::int64_t searches = 0;

  std::vector<ContactChunk> chunks; // of as many chunks of rows as are computed at a time
  std::vector<Contact> now;         // those of the step, before they replace State::contacts
  std::vector<Node> force;          // N, of contacts (n_nodes); empty without; written by contact_forces
  std::vector<double> stiffness;    // N/m, of contacts at nodes, row sums (n_nodes)
  std::vector<TouchedNode> touched; // nodes with a force, in the order of the contacts
};

} // namespace cdem
