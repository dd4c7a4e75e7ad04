// The only function that changes topology between steps: it takes the old Model and State and returns new ones, with
// every field transferred.
//
// A successor block is a whole old block, or a part of one; meshes are kept whole or left out. Its nodes take displacement
// and velocity from the old block's tets at their place, its parts together the old momenta (cut_motion.hpp). Springs of an
// interface that was there before take mode, offset (preload, slip) and damage from the nearest old spring. Springs on a
// new cut start intact with the traction the parent's stress has there, as an offset. Without it the cut would shake the
// model.
#pragma once

#include "libcdem/fracture/options.hpp"
#include "libcdem/model/build/build_model.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct Successor {
  int old_block = 0;
  geom::Polyhedron shape;
  std::vector<int> old_face; // per face of shape: the face of the old block it lies in, or geom::cut_face
  bool whole = true;         // the old block itself: keeps its id and generation
};

struct Rebuilt {
  Model model;
  State state;
  std::vector<int> old_block; // per new block: where it comes from (the one old -> new map)
};

Successor whole_block(const Model&, int block);

// cut_joint: per body, index of the joint on faces that a cut makes (into Model::joints, which the caller may have
// lengthened); empty: the body's own.
Rebuilt rebuild(const Model&, const State&, std::vector<Successor>, const std::vector<int>& cut_joint,
                MayBreak);

} // namespace cdem
