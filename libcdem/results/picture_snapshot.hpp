// What a picture shows of a model: the tetrahedra at its outer and broken faces with one field, and broken bonds. Among
// several ranks each makes its share, and rank 0 puts them together in the order of the model, so that it is the same
// for any number of them. A million tetrahedra have some ten thousand at their surface.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct PictureWish {
  std::string field;        // "stress.xx"; "": plain. Fields that are not wanted are named without values
  bool stress = false;      // beside the field
  bool broken_bonds = true; // wanted
  WaterWish water;          // given to the snapshot by add_water (free_surface.hpp)
};

// The field is made of bonds or joints around each tet, of which a rank knows its own only: State must be whole.
bool needs_whole(const PictureWish&);

// `state` is whole, or the share of this rank: then all ranks call it together, and the others get no values.
Snapshot make_picture_snapshot(const Model&, const State&, const PictureWish&, const std::string& title);

} // namespace cdem
