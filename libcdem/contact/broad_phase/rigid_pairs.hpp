// Pairs of rigid convex blocks: which there are, how far the two have moved relative to each other, and which of them a
// search finds anew. Equal on all ranks, which all move all rigid bodies.
#pragma once

#include "libcdem/contact/broad_phase/candidates.hpp"

namespace cdem {

// Writes RigidPairs::pairwise, planes, radius and pose.
void find_pairwise(const Model&, const State&, const ContactFragments&, RigidPairs&);
// Writes RigidPairs::pose.
void set_poses(const Model&, const State&, RigidPairs&);

inline bool pairwise(const RigidPairs& pairs, int block_a, int block_b) {
  return pairs.pairwise[block_a] && pairs.pairwise[block_b];
}

// b seen from a.
BodyPose seen_from(const BodyPose& a, const BodyPose& b);
// m, that no place within the radius of a body moves further between two poses.
double motion_between(const BodyPose&, const BodyPose&, double radius);
// The pair as it is when it is searched. skin: m.
RigidPair pair_of(const SurfaceSizes&, const RigidPairs&, int block_a, int block_b, double skin);
// Writes RigidPair::moved and from.
void update_motion(const RigidPairs&, RigidPair&);

inline double path_of(const RigidPairs& pairs, const RigidPair& pair) {
  return pairs.path[pair.a] + pairs.path[pair.b];
}

// True when one has left its skin.
bool any_left_skin(RigidPairs&);

// m, a block with these slacks around it holds all that its nearest places may take for inside.
double slack_of(const Model&, const ContactWork&, int block);

// m, how far the plane of a face parts the two, at least: until they have moved so far no semi-spring of one stands in the other.
// 0: no plane was found. Of a pair whose motion is up to date; writes RigidPair::planes and others_until.
double parted_by(const Model&, const State&, const ContactWork&, RigidPair&);

// What a search finds anew of rigid pairs.
struct PairsSearched {
  std::vector<RigidPair> pairs; // those there are now, as RigidPairs::all
  std::vector<int> searched;    // of them
  std::vector<int> now;         // per pair before: its number now, if it keeps its rows; else -1
  bool kept = false;            // one keeps its rows
};
// near: blocks near each other; null: those of before, as blocks are not searched. pace: m in a step, per block.
PairsSearched pairs_to_search(const Model&, const State&, const ContactWork&, const SearchMargin&,
                              const std::vector<double>& pace, const Pairs* near);

// What `before` knows of rigid pairs goes on in a workspace that is new otherwise.
void keep_rigid_pairs(ContactWork& before, ContactWork&);

// -1: there is none. By number.
int number_of(const std::vector<RigidPair>&, int block_a, int block_b);

} // namespace cdem
