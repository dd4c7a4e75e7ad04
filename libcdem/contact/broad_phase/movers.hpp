// What moves by itself: a block, or a fragment of a block some of whose faces have broken; and how fast it does.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct Renewed; // broad_phase/renewed.hpp

// Knowledge of movers that go on is carried over.
void find_fragments(const Model&, const State&, Movers&, MoverMotion&);

// m/s, per mover, of its fastest node; of a block that has broken the fastest of its nodes.
std::vector<double> speeds_of_movers(const Model&, const State&, const ContactWork&, int threads);

// Writes MoverMotion::last_displacement, of the step that is as long as ContactWork::step.
void set_displacements(const Model&, const State&, ContactWork&, int threads);

// Writes MoverMotion::drift and swing; begin_drifts: at_search, of those that are searched.
void set_drifts(const Model&, const State&, ContactWork&, int threads);
void begin_drifts(const Model&, const State&, const Movers&, const Renewed&, MoverMotion&);

// m, upper bound of the distance of a mover's nodes from their positions at its search. For a fragment it is less than the
// distance that it has travelled, since a piece that trembles stays in place.
inline double gone_at_most(const Model& model, const MoverMotion& motion, int mover) {
  return mover < static_cast<int>(model.blocks.size()) ? motion.travelled[mover]
                                                       : motion.drift[mover].norm() + motion.swing[mover];
}

// m, at most, that places of two fragments have gone relative to each other since the difference of their drifts and the
// sum of their swings were these.
double gone_since(const MoverMotion&, int mover_a, int mover_b, const std::array<float, 3>& drifts,
                  float swings);

// Nodes on the surface of a fragment: its search costs as much.
inline int size_of(const Movers& movers, int mover) {
  const int* const begin = &movers.node_begin[mover - movers.count() + movers.node_begin.size() - 1];
  return begin[1] - begin[0];
}

// A fragment of a broken block that is more than a single tet.
inline bool of_several_tets(const Model& model, const Movers& movers, int mover) {
  return mover >= static_cast<int>(model.blocks.size()) && movers.triangles_of_tet[mover][0] < 0;
}

// Such a fragment within which bonds hold tets together.
inline bool held_by_bonds(const Model& model, const Movers& movers, int mover) {
  return of_several_tets(model, movers, mover) && !movers.one_piece[mover];
}

// By how much edges of a target's triangles that lie on each other may part, over the height of a tet: where bonds hold its
// tets together, as much as these open.
inline double gives_of(const Model& model, const ContactWork& work, int block, int mover) {
  return !work.movers.one_piece[mover] && has_bonds(model, block) ? work.sizes.bonds_give[block]
                                                                  : same_place_at_least;
}

} // namespace cdem
