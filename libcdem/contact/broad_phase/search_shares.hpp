// A search with several ranks. The pairs of blocks are assigned to the ranks by counted loads. Each rank sends the pairs that
// it finds near a source to the rank that keeps the row (data/row_owner.hpp). Runs of triangles are cut by the rows and
// candidates that a search of all blocks has found. A single rank searches and keeps everything.
#pragma once

#include "libcdem/contact/broad_phase/candidates.hpp"

namespace cdem {

// Items that this rank computes, ascending; load: of each item. The heaviest items come first, and each goes to the
// rank with the least load. So neighbours, which have similar loads, go to different ranks.
std::vector<std::int64_t> own_share(const ContactWork&, const std::vector<double>& load);

// Triangles of the two blocks that stand where their boxes meet, as if they were spread evenly in these; of which a search
// looks at so many.
double near_triangles_of(const ActiveSurface&, int block_a, int block_b);

// What a search found near each other, and beside it.
struct FoundNear {
  std::vector<std::vector<Near>> springs, edges;           // in parts
  double may_go = std::numeric_limits<double>::infinity(); // m, Searches::undefined_pair_margin
  std::string wrong; // what is wrong with the first pair that is; empty: nothing
};

// Afterwards `springs` and `edges` are those of rows that this rank keeps, and the rest is known to all. all: of all
// blocks, for which it writes ContactWork::triangle_begin.
void share_found(const Model&, ContactWork&, bool all, FoundNear&);

} // namespace cdem
