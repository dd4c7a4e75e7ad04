// What contact needs beside Model and State and throws away with its stage: which triangles and edges are near enough
// to look at, and the forces of the step.
//
// A mover is what moves by itself: a block, or a fragment of a block some of whose faces have broken. A search finds what
// can touch before a mover has gone further than its skin; none of it changes a force. A pair found near sleeps until its
// two movers have moved as far as it was apart: `recheck_distance` is compared with the sum of the ways the two have gone
// since the search. A row sleeps as long as all its pairs must. Lengths kept as floats are rounded to the side on which
// more is looked at.
#pragma once

#include "libcdem/contact/data/rigid_sums.hpp"
#include "libcdem/integrate/contact_on_rigid.hpp"
#include "libcdem/model/contact_surface.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"
#include "libcdem/state/contact.hpp"

#include <array>
#include <limits>
#include <vector>

namespace cdem {

class SharedState; // ranks/shared_state.hpp

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

// The targets near one source (triangle or edge) of one fragment (springs) or mover (edges), by number.
struct ContactRow {
  int source = 0;
  int block = 0;                      // of its targets
  int source_mover = 0, mover = 0;    // of the source, and of its targets
  std::uint32_t begin = 0, count = 0; // into candidates
  // m, what is further off may sleep. Of springs: contacts are at most that deep; 0: not looked at yet. Of edges: as deep
  // as any may get before the next search.
  float reach = 0;
  float recheck_distance = 0; // m, of its targets the least
  bool hindered = false;      // of edges: some sleep only as long as no contact stands on the edges around
  std::uint8_t plane = 0;     // of springs and a single tet: which of its planes parted them best, from 0
  // Of two fragments, when it was last looked at: m, how far they may go until it is again, and the difference of their
  // drifts and the sum of their swings then.
  float allowed = 0, swings = 0;
  std::array<float, 3> drifts{};
  // Per semi-spring, of what was found when all its targets were last looked at: until the two movers have gone so far, m,
  // it touches nothing (target -1) or nothing but this triangle.
  std::array<float, 3> known_until{};
  std::array<int, 3> known_target{-1, -1, -1};
};

// What movers there are. Those of blocks come first and have the numbers of their blocks.
struct Movers {
  std::vector<int>
      of_triangle; // of each triangle that takes part: its block, or its fragment where faces have broken
  std::vector<int> block;       // per mover
  std::vector<int> of_fragment; // by its smallest node; -1: none
  std::vector<int> node_begin,
      nodes; // per fragment, from the first after the blocks on: the nodes of its triangles
  // Per mover: no bond holds its tets together, as where it is a single one. Of fragments.
  std::vector<char> one_piece;
  // Per mover, of fragments that are a single tet: its triangles, by number; of all others -1. A semi-spring outside one of
  // their planes is outside the tet, by as much at least: that is looked at before anything else.
  std::vector<std::array<int, 4>> triangles_of_tet;

  int count() const { return static_cast<int>(block.size()); }
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
  double friction = 0, damping = 0; // J, this step, rounded once
  std::int64_t contacts = 0;        // of all ranks
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

// Of a fragment another one that may come near it before the two leave their skins.
struct NearMover {
  int fragment = 0; // by its smallest node
  int search = 0;   // that found it
  float may_go = 0; // m, relative to each other since then, before their rows are to be found anew
  float swings = 0; // m, then
  std::array<float, 3> drifts{};
};

// What tells of all rows which ones sleep, side by side: it is gone through in every step.
struct RowsAsleep {
  std::vector<float> recheck_distance;  // m, per row; 0 where more than that decides
  std::vector<int> source_mover, mover; // per row
  std::vector<std::uint64_t> hindered;  // per chunk of rows, a bit each: ContactRow::hindered
  std::vector<std::uint64_t> awake;     // per chunk of rows, a bit each: it is looked at in this step
};
static_assert(contact_rows_per_chunk == 64, "a bit per row");

struct ContactWork {
  std::array<std::vector<ContactRow>, 2> rows; // of springs, of edges; of the sources that this rank keeps
  std::array<RowsAsleep, 2> asleep;
  std::array<std::vector<ContactCandidate>, 2> candidates;
  // Per node, and per triangle: what hangs together, by its smallest node. Over faces without a broken bond only, so that
  // the surface of what has broken is closed.
  std::vector<int> fragment_of_node, fragment;
  std::vector<char>
      active; // per triangle: 1 outside, or its face has a broken bond; 2 its face is left to contact; else 0
  // Per triangle of blocks that have broken, m, undeformed: what may meet it of what it hangs together with does not meet
  // this box; empty before any has.
  std::vector<geom::Box> boxes_at_first;
  std::vector<char> boxed; // per block: it has such boxes
  Movers movers;
  std::vector<char> changed;      // per mover: fragments were told apart for this look, and it is a new one
  std::vector<char> broken;       // per block: some of its faces have
  std::vector<ContactEdge> edges; // of surfaces as they are now, by id
  std::vector<int> edge_begin;    // (n_triangles + 1) into edges, by their first triangle
  // Per edge: where the edges of its fragment that meet at its two ends begin in edges_at.
  std::vector<std::array<int, 2>> edge_ends;
  std::vector<int> edges_at; // by end, each list closed by -1
  // Per edge and end: where the edges in which its line continues begin in edges_beyond.
  std::vector<std::array<int, 2>> edge_continues;
  std::vector<EdgeBeyond> edges_beyond; // by edge and end, each list closed by -1
  // Per edge, and per mover: it had a contact of edges before the step.
  std::vector<char> edge_touched, mover_edges_touched;
  std::vector<double> travelled; // m, per mover, at most, since the search
  // Of fragments, since their last search, per mover: what their nodes have gone in the mean, and how far one of them is
  // from that, m. By where they were then (n_nodes).
  std::vector<geom::Vec3> drift;
  std::vector<double> swing;
  std::vector<geom::Vec3> at_search;        // m
  std::vector<std::vector<NearMover>> near; // per mover
  // Per mover, of fragments: the last search of it; how far it may travel before the others near it are looked at; the
  // part that is left of what it may go relative to the one that is worst off.
  std::vector<int> search_of;
  std::vector<double> look_at, left;     // m, 1
  std::vector<double> past_others;       // m, how far it has gone past those around it
  std::vector<double> last_displacement; // m, per mover, at most, in the last step
  double last_step = 0;                  // s, the last one in which anything moved
  std::vector<double> skin;              // m, per mover: how far it may go before the next search
  std::vector<double> inner_skin;        // m, of fragments: how far relative to those near it
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
  bool looks_at_all = false; // in every step, after a search of all movers: for tests of what is skipped
  bool all_due = false;      // a search is due of all movers, not only of fragments that left their skins
  // A search goes on from here as if nothing of fragments had been known, as that of a stage that goes on from here does.
  bool anew = true;
  // Of this look: contacts begin however deep they are, as it cannot be known which fragments are new. Otherwise those of
  // movers that have changed do.
  bool any_depth_begins = false;
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

  // With several ranks, each of which keeps the rows that stand at a run of triangles (data/row_owner.hpp); null:
  // this one keeps all.
  SharedState* shared = nullptr;
  std::vector<std::int64_t> triangle_begin; // (ranks + 1)

  std::vector<ContactChunk> chunks; // of as many chunks of rows as are computed at a time
  std::vector<Contact> now;         // those of the step, before they replace State::contacts
  std::vector<Node> force;          // N, of contacts (n_nodes); empty without; written by contact_forces
  std::vector<double> stiffness;    // N/m, of contacts at nodes, row sums (n_nodes)
  std::vector<TouchedNode> touched; // nodes with a force, in the order of the contacts; none of rigid bodies
  // Of rigid bodies, by number: the sums as contacts are added, and their values, which all ranks know.
  std::vector<RigidSums> rigid_sums;
  std::vector<ContactOnRigid> on_rigid;
};

} // namespace cdem
