// Data of contact that live for one stage, beside Model and State: the candidates, that is triangles and edges that are
// near each other, and the forces of the step.
//
// A mover is a body that moves by itself: a block, or a fragment of a block with broken faces. A search finds the pairs
// that can touch before a mover has moved further than its skin. The search never changes a force. A near pair is
// skipped until its two movers have moved by its distance: `recheck_distance` is compared with the sum of the distances
// that the two have moved since the search. A row is skipped as long as all its pairs are. Lengths stored as floats are
// rounded such that more pairs are checked, never fewer. Two rigid convex
// blocks have rows of their own. These rows depend on the relative motion of the two (RigidPair) and stay as long as that
// motion is within the skin of the pair.
#pragma once

#include "libcdem/contact/data/rigid_pair.hpp"
#include "libcdem/contact/data/rigid_sums.hpp"
#include "libcdem/integrate/contact_on_rigid.hpp"
#include "libcdem/model/contact_surface.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"
#include "libcdem/state/contact.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace cdem {

class SharedState;  // ranks/shared_state.hpp
struct TetContacts; // contact/data/tet_contacts.hpp

inline constexpr std::int64_t contact_rows_per_chunk = 64;
// Depth over the usual height of a tet at a block's surface: around a deeper contact all pairs are computed in every
// step.
inline constexpr double shallow_ratio = 0.01;
// Largest depth of a contact, over the height of a tet.
inline constexpr double depth_ratio = 0.25;

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

// The targets near one source (triangle or edge) of one fragment (springs) or mover (edges), by number.
struct ContactRow {
  int source = 0;
  int block = 0;                      // of its targets
  int source_mover = 0, mover = 0;    // of the source, and of its targets
  std::uint32_t begin = 0, count = 0; // into candidates
  // m, candidates further away may be skipped. For springs: contacts are at most that deep; 0: not computed yet. For
  // edges: the depth that any contact may reach before the next search.
  float reach = 0;
  float recheck_distance = 0; // m, of its targets the least
  bool hindered = false;      // of edges: some sleep only as long as no contact stands on the edges around
  // The targets of this row of springs belong to several blocks, which bonds hold together; `mover` is that of the first.
  bool several_movers = false;
  std::uint8_t plane = 0; // of springs: which of the planes of their target parted them best, from 0
  int pair = -1;          // of two rigid convex blocks, into ContactWork::rigid_pairs; -1: of others
  int place = -1;         // into RowsAsleep::of_pairs
  // For two fragments, from the last check: m, the distance that they may move until the next check, and the difference
  // of their drifts and the sum of their swings at that time.
  float allowed = 0, swings = 0;
  std::array<float, 3> drifts{};
  // Per semi-spring, of what was found when all its targets were last looked at: until the two movers have gone so far, m,
  // it touches nothing (target -1) or nothing but this triangle.
  std::array<float, 3> known_until{};
  std::array<int, 3> known_target{-1, -1, -1};
};

// What is not as it was when fragments were told apart before, of a triangle: each holds what stands before it.
enum class Change : char {
  none,
  fragment, // or who holds its face: springs or contact
  surface   // it was not active
};

// What movers there are. Those of blocks come first and have the numbers of their blocks.
struct Movers {
  std::vector<int>
      of_triangle; // of each triangle that takes part: its block, or its fragment where faces have broken
  std::vector<int> block;    // per mover
  std::vector<int> fragment; // per mover, its smallest node; -1: a block
  std::vector<int> node_begin,
      nodes; // per fragment, from the first after the blocks on: the nodes of its triangles
  // Per mover, for fragments: no bond holds its tets together, as in a fragment of a single tet.
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
  std::array<int, 4> source{}, target{};
  std::array<double, 4> on_source{};       // weights, their sum 1
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

// Motion of a block as a whole.
struct BlockMotion {
  bool whole = false; // it has one
  geom::Vec3 centroid = geom::Vec3::Zero(), velocity = geom::Vec3::Zero(),
             spin = geom::Vec3::Zero(); // m, m/s, rad/s
};

struct TouchedNode {
  int node = 0, block = 0;
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
  std::vector<int> source_mover, mover; // per row
  std::vector<std::uint64_t> hindered;  // per chunk of rows, a bit each: ContactRow::hindered
  std::vector<std::uint64_t> awake;     // per chunk of rows, a bit each: it is looked at in this step
};
static_assert(contact_rows_per_chunk == 64, "a bit per row");

// Per face of a tet of a block that has broken: the tet that whole bonds, or nodes, hold to it there; or why there is none.
struct TetsBeyond {
  static constexpr int none = -1, deep = -2; // it is the surface; the tet has no node on the surface
};

struct ContactWork {
  std::array<std::vector<ContactRow>, 2> rows; // of springs, of edges; of the sources that this rank keeps
  std::array<RowsAsleep, 2> asleep;
  std::array<std::vector<ContactCandidate>, 2> candidates;
  // Per node, and per triangle: what hangs together, by its smallest node. Over faces without a broken bond only, so that
  // the surface of what has broken is closed.
  std::vector<int> fragment_of_node, fragment;
  std::vector<char>
      active; // per triangle: 1 outside, or its face has a broken bond; 2 its face is left to contact; else 0
  std::vector<int> neighbours;                 // mesh_neighbours; empty before any block has broken
  std::vector<std::array<int, 4>> tets_beyond; // TetsBeyond, per tet of the mesh, by face (geom::tet_faces)
  Movers movers;
  // Per triangle, where fragments were told apart for this look: its contacts may begin at any depth.
  std::vector<Change> changed;
  std::vector<char> broken;       // per block: some of its faces have
  std::vector<ContactEdge> edges; // of surfaces as they are now, by id
  std::vector<int> edge_begin;    // (n_triangles + 1) into edges, by their first triangle
  // Per triangle and side of it, from its corner to the next: the triangle beyond the edge there; -1: no edge.
  std::vector<std::array<int, 3>> beyond_edge;
  // Per edge: where the edges of its fragment that meet at its two ends begin in edges_at.
  std::vector<std::array<int, 2>> edge_ends;
  std::vector<int> edges_at; // by end, each list closed by -1
  // Per edge and end: where the edges in which its line continues begin in edges_beyond.
  std::vector<std::array<int, 2>> edge_continues;
  std::vector<EdgeBeyond> edges_beyond; // by edge and end, each list closed by -1
  // Per edge, and per mover: it had a contact of edges before the step.
  std::vector<char> edge_touched, mover_edges_touched;
  std::vector<double> travelled; // m, per mover, at most, since the search
  // Of blocks that are rigid, convex and bonded to no other: 1. Of them, per block, how they stand, and their radius; and
  // triangles in the planes of their faces, by number.
  std::vector<char> pairwise;
  std::vector<BodyPose> pose;
  std::vector<double> radius; // m
  std::vector<std::vector<int>> planes;
  std::vector<double> path;           // m, per block, of its fastest node, never less than it was
  std::vector<RigidPair> rigid_pairs; // of pairwise blocks near each other, by their two numbers
  // For fragments, per mover, since their last search: mean displacement of their nodes, and largest deviation of a
  // node from it, m. Measured from the positions at that search (n_nodes).
  std::vector<geom::Vec3> drift;
  std::vector<double> swing;
  std::vector<geom::Vec3> at_search;         // m
  std::shared_ptr<TetContacts> tet_contacts; // of blocks with themselves; null: none is broken
  std::vector<double> last_displacement;     // m, per mover, at most, in the last step
  double last_step = 0;                      // s, the last one in which anything moved
  std::vector<double> skin;                  // m, per mover: how far it may go before the next search
  double undefined_pair_margin =
      0;                   // m, that two blocks for which no contact is given may go before a search is due
  double usual_height = 0; // m, of a tet at any surface: of skins, which change no force
  // m, per block, a part of what is usual at its own surface: so deep contacts may begin, and the least reach of a row.
  std::vector<double> shallow;
  std::vector<double> bonds_give; // per block, over a tet's height: how far bonds let edges part
  bool fragments_due = true;      // faces have broken, or fragments are not known: a search is due with them
  std::vector<char> told_due;     // per block: that search is told of its faces first; with fragments_due
  bool due = true;                // something moved since the contacts were looked at
  // State::contacts holds all there are, but for fragments. Not so where a stage begins: what stands in what then is
  // anybody's doing.
  bool history_complete = false;
  bool looks_at_all = false; // in every step, after a search of all movers: for tests of what is skipped
  bool blocks_due = false;   // a search is due of all movers, not only of fragments that left their skins
  bool pairs_due = false;    // a search is due of rigid pairs that left their skins
  bool all_due = false;      // a search of all movers is due in which no rigid pair keeps its rows
  bool anew = true;          // a search goes on as if nothing of fragments had been known
  // In this step contacts begin at any depth, since it is not known which fragments are new: all contacts, or those of
  // blocks of which faces have been freed or have broken. Otherwise only contacts of movers that have changed do.
  bool any_depth_begins = false, any_depth_of_broken = false;
  std::vector<char> freed; // per block: some of its faces have been
  double step = 0;         // s, since then
  // Tangent of the largest friction angle of any contact, for a stage that wants less than joints give.
  double most_friction = std::numeric_limits<double>::infinity();
  bool restitution = false; // some contact law has one below 1, and the stage wants it
  std::vector<double>
      block_forces; // N, per block, of all springs that pressed on it before the step; with restitution
  std::vector<BlockMotion> block_motion; // per block, of those that touched before the step; with restitution
  int skin_doublings = 0; // how often skins have been doubled, as searches followed each other closely
  std::int64_t steps_since_search = 0; // steps since the search
  std::int64_t steps = 0;              // since the stage began
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
  // Per rigid body: the sums as contacts are added, and their values, which all ranks know.
  std::vector<RigidSums> rigid_sums;
  std::vector<ContactOnRigid> on_rigid;
};

} // namespace cdem
