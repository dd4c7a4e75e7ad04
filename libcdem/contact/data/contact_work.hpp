// Data of contact that live for one stage, beside Model and State. A search finds the pairs that can touch before a block
// has moved further than its skin. The search never changes a force.
#pragma once

#include "libcdem/contact/data/contact_force.hpp"
#include "libcdem/contact/data/contact_fragments.hpp"
#include "libcdem/contact/data/contact_rows.hpp"
#include "libcdem/contact/data/flat_faces.hpp"
#include "libcdem/contact/data/rigid_pair.hpp"
#include "libcdem/contact/data/surface_edges.hpp"
#include "libcdem/parallel/chunks.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <unordered_map>

namespace cdem {

class SharedState;  // ranks/shared_state.hpp
struct TetContacts; // contact/data/tet_contacts.hpp

// Depth over the usual height of a tet at a block's surface: around a deeper contact all pairs are computed in every
// step.
inline constexpr double shallow_ratio = 0.01;
// Largest depth of a contact, over the height of a tet.
inline constexpr double depth_ratio = 0.25;

// A stage's wishes of its contacts.
struct ContactOptions {
  bool looks_at_all = false; // in every step, after a search of all blocks: for tests of what is skipped
  // Tangent of the largest friction angle of any contact, for a stage that wants less than joints give.
  double most_friction = std::numeric_limits<double>::infinity();
};

// Sizes of the model's surfaces; written by start_contact.
struct SurfaceSizes {
  double usual_height = 0; // m, of a tet at any surface: of skins, which change no force
  // m, per block, a part of what is usual at its own surface: so deep contacts may begin, and the least reach of a row.
  std::vector<double> shallow;
  std::vector<double> bonds_give; // per block, over a tet's height: how far bonds let edges part
  std::vector<char> freed;        // per block: some of its faces have been
};

// How far the blocks have moved since they were searched.
struct BlockTravel {
  std::vector<double> skin; // m, per block: how far it may go before the next search; written by choose_skins
  std::vector<double> travelled;         // m, per block, at most, since the search
  std::vector<double> last_displacement; // m, per block, of its fastest node in the last step
  double last_step = 0;                  // s, the last one in which anything moved
};

// When a search is due, and what has come of those before.
struct Searches {
  bool fragments_due = true;  // faces have broken, or fragments are not known: a search is due with them
  std::vector<char> told_due; // per block: that search is told of its faces first; with fragments_due
  bool blocks_due = false;    // a search is due of all blocks
  bool pairs_due = false;     // a search is due of rigid pairs that left their skins
  bool all_due = false;       // a search of all blocks is due in which no rigid pair keeps its rows
  bool anew = true;           // a search goes on as if nothing of fragments had been known
  // State::contacts holds all there are, but for fragments. Not so where a stage begins: what stands in what then is
  // anybody's doing.
  bool history_complete = false;
  double undefined_pair_margin =
      0;                  // m, that two blocks for which no contact is given may go before a search is due
  int skin_doublings = 0; // how often skins have been doubled, as searches followed each other closely
  std::int64_t steps_since = 0; // the last one
  std::int64_t count = 0;
};

// Motion of a block as a whole.
struct BlockMotion {
  bool whole = false; // it has one
  geom::Vec3 centroid = geom::Vec3::Zero(), velocity = geom::Vec3::Zero(),
             spin = geom::Vec3::Zero(); // m, m/s, rad/s
};

// N, of the contacts between two blocks: sums of the forces of that name (state/contact.hpp).
struct PairForces {
  double felt = 0, usual = 0;
};

struct ContactWork {
  ContactOptions options;
  SurfaceSizes sizes;
  ContactFragments fragments;
  SurfaceEdges edges;
  FlatFaces faces; // written by start_contact
  BlockTravel travel;
  RigidPairs rigid_pairs;
  Searches search;
  std::array<ContactRows, 2> rows;           // of springs, of edges
  std::shared_ptr<TetContacts> tet_contacts; // of blocks with themselves; null: none is broken

  bool due = true; // something moved since the contacts were looked at
  double step = 0; // s, since then
  // In this step contacts begin at any depth, since it is not known which fragments are new: all contacts, or those of
  // blocks of which faces have been freed or have broken. Otherwise only contacts of fragments that have changed do.
  bool any_depth_begins = false, any_depth_of_broken = false;
  EdgesTouched edges_touched;
  bool knows_motions = false; // of blocks as wholes: some contact law has a restitution below 1
  bool damps = false;         // contacts may lose energy by damping, and the stage wants it
  std::vector<double>
      block_forces; // N, per block, of all springs that pressed on it before the step; where they damp
  std::vector<double> block_stiffness; // N/m, per block, of the same springs; likewise
  std::unordered_map<std::uint64_t, PairForces>
      pair_forces;                       // by two blocks; likewise, with a block that deforms
  std::vector<BlockMotion> block_motion; // per block, of those that touched before the step; if known

  std::vector<ContactChunk> chunks; // of as many chunks of rows as are computed at a time
  std::vector<Contact> now;         // those of the step, before they replace State::contacts
  ContactLoads loads;

  // With several ranks, each keeps the rows that stand at a run of triangles (data/row_owner.hpp).
  SharedState* shared = nullptr;            // of the Workspace; never null where contacts are looked at
  std::vector<std::int64_t> triangle_begin; // (ranks + 1)
};

} // namespace cdem
