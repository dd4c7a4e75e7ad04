// Among several ranks: who keeps the row of a source and a target. All contacts of two rigid bodies stand at the later one,
// so that edges know of each other, and ground that many bodies lie on is shared out by them; others stand at their
// source. Each rank keeps the rows of a run of triangles.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/ranks/partition.hpp"
#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>

namespace cdem {

inline bool both_rigid(const Model& model, int block_a, int block_b) {
  return model.blocks[block_a].rigid >= 0 && model.blocks[block_b].rigid >= 0;
}

// Only the resultants of contacts of two rigid bodies are told to other ranks.
inline bool is_told_by_sums(const Model& model, const Contact& c) {
  if (c.kind == Contact::tets)
    return false;
  const auto [source, target] = triangles_of(c);
  const std::vector<ContactTriangle>& triangles = model.surface.triangles;
  return both_rigid(model, triangles[source].block, triangles[target].block);
}

// The triangle at which a row stands; source, target: triangles, of edges their first ones.
inline int triangle_of_row(const Model& model, int source, int target) {
  const ContactSurface& s = model.surface;
  const int a = s.triangles[source].block, b = s.triangles[target].block;
  return both_rigid(model, a, b) ? s.block_begin[std::max(a, b)] : source;
}

inline int owner_of_row(const Model& model, const ContactWork& work, int source, int target) {
  return Partition::owner(work.triangle_begin, triangle_of_row(model, source, target));
}

inline bool keeps(const Model& model, const ContactWork& work, const Contact& c) {
  if (work.shared->alone())
    return true;
  const auto [source, target] = triangles_of(c);
  return owner_of_row(model, work, source, target) == work.shared->part().rank;
}

} // namespace cdem
